#include "cad_import/layout/layout_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

#include "core/error.h"
#include "tests/cad_import/error_of.h"
#include "tests/cad_import/sample_files.h"
#include "tests/core/solids.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::cad_import {
namespace {

using core::ErrorKind;
using core::LengthUnit;
using core::testing::Box;
using testing::ErrorOf;
using testing::Mentions;

constexpr double kRotationRounding = 1e-12;  // two conversions between angles and matrix

// Lines are counted from 1 in the tests below.
constexpr const char* kLayout = R"(unit = "cm"

[[part]]
name = "pmt box"
file = "parts/box.stl"
position_mm = [10, 20.5, -30]
rotation_rpy_deg = [0, 0, 90]

[[part]]
name = "payload A"
file = "parts/box.stl"
unit = "in"

[[part]]
name = "payload B"
file = "parts/metres.glb"

[[spacing]]
name = "gap"
moving = "payload A"
reference = "pmt box"
axis = "z"
min_mm = 100
max_mm = 300.5
initial_mm = 140

[[pair]]
a = "payload A"
b = "payload B"
required_clearance_mm = 5
authorised_contact = true
)";

class LayoutFile : public ::testing::Test {
 protected:
  void SetUp() override {
    test_support::WriteText(folder_ / "parts/box.stl", testing::StlText(Box({1, 2, 3})));
    const auto glb = testing::Gltf(Box({0.1, 0.2, 0.3}), {R"({"mesh":0})"}, {0}, "");
    test_support::WriteText(folder_ / "parts/metres.glb", testing::Glb(glb));
  }
  std::filesystem::path Write(const std::string& text) {
    test_support::WriteText(folder_ / "LAYOUT.toml", text);
    return folder_ / "LAYOUT.toml";
  }
  // kLayout with its first `from` replaced.
  std::filesystem::path WriteWith(const std::string& from, const std::string& to) {
    std::string text = kLayout;
    EXPECT_NE(text.find(from), std::string::npos) << from;
    return Write(text.replace(text.find(from), from.size(), to));
  }
  // The message of what WriteWith(from, to) leads to; it must say that file and that line.
  std::string ErrorAtLine(int line, const std::string& from, const std::string& to,
                          ErrorKind kind = ErrorKind::kFormat) {
    const auto path = WriteWith(from, to);
    std::string message = ErrorOf(kind, [&] { (void)ImportLayoutFile(path); });
    EXPECT_TRUE(Mentions(message, path.string() + ":" + std::to_string(line) + ": ")) << message;
    return message;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(LayoutFile, EveryKeyArrives) {
  const core::Layout layout = ImportLayoutFile(Write(kLayout)).layout;
  EXPECT_EQ(layout.unit, LengthUnit::kCentimetre);
  ASSERT_EQ(layout.parts.size(), 3U);
  const core::Part& box = layout.parts[0];
  EXPECT_EQ(box.name, "pmt box");
  EXPECT_EQ(box.file, "parts/box.stl");
  EXPECT_EQ(box.world_from_part, core::FromPositionAndRollPitchYaw({10, 20.5, -30}, {0, 0, 90}));
  ASSERT_EQ(layout.spacings.size(), 1U);
  const core::Spacing& gap = layout.spacings[0];
  EXPECT_EQ(gap.name, "gap");
  EXPECT_EQ(gap.moving, "payload A");
  EXPECT_EQ(gap.reference, "pmt box");
  EXPECT_EQ(gap.axis, core::Axis::kZ);
  EXPECT_EQ(gap.min_mm, 100.0);
  EXPECT_EQ(gap.max_mm, 300.5);
  EXPECT_EQ(gap.initial_mm, 140.0);
  ASSERT_EQ(layout.pair_rules.size(), 1U);
  EXPECT_EQ(layout.pair_rules[0].a, "payload A");
  EXPECT_EQ(layout.pair_rules[0].b, "payload B");
  EXPECT_EQ(layout.pair_rules[0].required_clearance_mm, 5.0);
  EXPECT_TRUE(layout.pair_rules[0].authorised_contact);
  EXPECT_FALSE(layout.pair_rules[0].ignore);
}

TEST_F(LayoutFile, APairThatIsIgnoredStaysSoWhenWritten) {
  const auto path = WriteWith("authorised_contact = true", "ignore = true");
  core::Layout layout = ImportLayoutFile(path).layout;
  EXPECT_TRUE(layout.pair_rules[0].ignore);
  EXPECT_FALSE(layout.pair_rules[0].authorised_contact);
  WriteLayoutFile(layout, folder_ / "copy.toml");
  EXPECT_TRUE(ImportLayoutFile(folder_ / "copy.toml").layout.pair_rules[0].ignore);
}

TEST_F(LayoutFile, APartsUnitGoesBeforeItsFilesAndThatBeforeTheLayouts) {
  const core::Layout layout = ImportLayoutFile(Write(kLayout)).layout;
  const auto size_mm = [&](std::size_t i) -> Eigen::Vector3d {
    return core::BoundsOf(*layout.parts[i].mesh).sizes();
  };
  EXPECT_EQ(layout.parts[0].unit, LengthUnit::kCentimetre);
  EXPECT_TRUE(size_mm(0).isApprox(Eigen::Vector3d(10, 20, 30)));
  EXPECT_EQ(layout.parts[1].unit, LengthUnit::kInch);
  EXPECT_TRUE(size_mm(1).isApprox(Eigen::Vector3d(25.4, 50.8, 76.2)));
  EXPECT_EQ(layout.parts[2].unit, LengthUnit::kMetre);
  EXPECT_TRUE(size_mm(2).isApprox(Eigen::Vector3d(100, 200, 300), 1e-6));  // a file of floats
}

TEST_F(LayoutFile, AFileUsedTwiceIsLoadedOnce) {
  const core::Layout layout = ImportLayoutFile(WriteWith("unit = \"in\"\n", "")).layout;
  EXPECT_EQ(layout.parts[0].mesh, layout.parts[1].mesh);
  EXPECT_NE(layout.parts[0].mesh, layout.parts[2].mesh);
}

TEST_F(LayoutFile, WarningsNameTheirPart) {
  EXPECT_TRUE(ImportLayoutFile(Write(kLayout)).warnings.empty());
  auto open = Box({1, 2, 3});
  open.triangles.pop_back();
  test_support::WriteText(folder_ / "parts/box.stl", testing::StlText(open));
  const auto warnings = ImportLayoutFile(folder_ / "LAYOUT.toml").warnings;
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_TRUE(Mentions(warnings[0], "part 'pmt box' (parts/box.stl): the surface isn't closed"))
      << warnings[0];
}

TEST_F(LayoutFile, UnknownKeysAreNamedWithTheirLineAndWhatWasMeant) {
  EXPECT_TRUE(Mentions(ErrorAtLine(6, "position_mm", "positon_mm"),
                       "[[part]]: unknown key 'positon_mm'; did you mean 'position_mm'?"));
  EXPECT_TRUE(Mentions(ErrorAtLine(25, "initial_mm", "inital_mm"), "did you mean 'initial_mm'?"));
  EXPECT_TRUE(Mentions(ErrorAtLine(31, "authorised_contact", "authorized_contact"),
                       "did you mean 'authorised_contact'?"));
  EXPECT_TRUE(Mentions(ErrorAtLine(1, "unit = \"cm\"", "units = \"cm\""), "did you mean 'unit'?"));
  EXPECT_TRUE(Mentions(ErrorAtLine(6, "position_mm = [10", "colour = 3\nposition_mm = [10"),
                       "unknown key 'colour'; remove it"));
}

TEST_F(LayoutFile, MissingAndWronglyTypedKeysAreNamedWithTheirLine) {
  EXPECT_TRUE(Mentions(ErrorAtLine(3, "name = \"pmt box\"\n", ""), "[[part]]: key 'name' is missing"));
  EXPECT_TRUE(Mentions(ErrorAtLine(4, "\"pmt box\"", "7"), "key 'name' must be a text"));
  EXPECT_TRUE(
      Mentions(ErrorAtLine(6, "[10, 20.5, -30]", "[10, 20.5]"), "key 'position_mm' must be three numbers"));
  EXPECT_TRUE(Mentions(ErrorAtLine(6, "[10, 20.5, -30]", "[10, nan, 0]"), "must be a finite number"));
  EXPECT_TRUE(Mentions(ErrorAtLine(7, "[0, 0, 90]", "\"upright\""), "key 'rotation_rpy_deg'"));
  EXPECT_TRUE(
      Mentions(ErrorAtLine(12, "\"in\"", "\"inch\""), "key 'unit' must be \"mm\", \"cm\", \"m\" or \"in\""));
  EXPECT_TRUE(Mentions(ErrorAtLine(22, "\"z\"", "\"up\""), "key 'axis' must be"));
  EXPECT_TRUE(Mentions(ErrorAtLine(24, "300.5", "true"), "key 'max_mm' must be a finite number"));
  EXPECT_TRUE(Mentions(ErrorAtLine(30, "= 5", "= -5"), "must not be negative"));
  EXPECT_TRUE(Mentions(ErrorAtLine(31, "= true", "= 1"), "must be true or false"));
}

TEST_F(LayoutFile, PartsThatDontExistAreNamedWithTheirLine) {
  EXPECT_TRUE(Mentions(ErrorAtLine(20, "moving = \"payload A\"", "moving = \"paylod A\""),
                       "[[spacing]]: key 'moving' names no part: 'paylod A'; did you mean 'payload A'?"));
  EXPECT_TRUE(Mentions(ErrorAtLine(29, "b = \"payload B\"", "b = \"chassis\""), "names no part: 'chassis'"));
}

TEST_F(LayoutFile, PartFilesThatFailAreNamedWithTheirLineAndPart) {
  const std::string missing = ErrorAtLine(5, "parts/box.stl", "parts/bx.stl", ErrorKind::kFile);
  EXPECT_TRUE(Mentions(missing, "part 'pmt box'") && Mentions(missing, "bx.stl: no such file")) << missing;
  const std::string unitless = ErrorAtLine(5, "unit = \"cm\"\n", "\n", ErrorKind::kCad);
  EXPECT_TRUE(Mentions(unitless, "carries no unit")) << unitless;
}

TEST_F(LayoutFile, LayoutsThatCantBeMetSayWhichLineAndWhy) {
  const auto error = [&](int line, const std::string& from, const std::string& to) {
    return ErrorAtLine(line, from, to, ErrorKind::kRange);
  };
  const std::string part = "[[part]]\nname = \"pmt box\"\nfile = \"parts/box.stl\"\n";
  EXPECT_TRUE(Mentions(error(19, "[[spacing]]", part + "[[spacing]]"), "two parts are named 'pmt box'"));
  EXPECT_TRUE(Mentions(error(25, "initial_mm = 140", "initial_mm = 99"), "min_mm <= initial_mm <= max_mm"));
  EXPECT_TRUE(Mentions(error(24, "max_mm = 300.5", "max_mm = 30"), "not 100 <= 140 <= 30"));
  EXPECT_TRUE(Mentions(error(21, "reference = \"pmt box\"", "reference = \"payload A\""),
                       "a part can't move against itself"));
  const auto with_spacing = [](const std::string& name, const std::string& moving,
                               const std::string& reference) {
    return "[[spacing]]\nname = \"" + name + "\"\nmoving = \"" + moving + "\"\nreference = \"" + reference +
           "\"\naxis = \"z\"\nmin_mm = 0\nmax_mm = 9\ninitial_mm = 5\n\n[[pair]]";
  };
  EXPECT_TRUE(Mentions(error(28, "[[pair]]", with_spacing("gap", "payload B", "pmt box")),
                       "two spacings are named 'gap'"));
  EXPECT_TRUE(Mentions(error(29, "[[pair]]", with_spacing("again", "payload A", "payload B")),
                       "spacing 'again': moves 'payload A' along z, as spacing 'gap' does"));
  EXPECT_TRUE(Mentions(error(30, "[[pair]]", with_spacing("back", "pmt box", "payload A")),
                       "the spacings 'gap', 'back' are circular"));
}

TEST_F(LayoutFile, AGroupMovesAsOneAndComesBack) {
  const std::string group = "[[group]]\nname = \"upper\"\nparts = [\"payload A\", \"payload B\"]\n";
  test_support::WriteText(folder_ / "LAYOUT.toml", kLayout);
  std::string text = kLayout;
  text.replace(text.find("moving = \"payload A\""), 20, "moving = \"upper\"");
  text.replace(text.find("a = \"payload A\""), 15, "a = \"upper\"");
  const core::Layout layout = ImportLayoutFile(Write(text + group)).layout;
  ASSERT_EQ(layout.groups.size(), 1U);
  EXPECT_EQ(layout.groups[0].parts, (std::vector<std::string>{"payload A", "payload B"}));
  const auto poses = core::PosesAt(layout, std::vector<double>{140.0});
  EXPECT_DOUBLE_EQ(core::GapMm(layout, layout.spacings[0], poses), 140.0);
  EXPECT_EQ(poses[1].translation_mm, poses[2].translation_mm) << "as they were authored";
  WriteLayoutFile(layout, folder_ / "copy.toml");
  const core::Layout back = ImportLayoutFile(folder_ / "copy.toml").layout;
  EXPECT_EQ(back.groups, layout.groups);
  EXPECT_EQ(back.spacings, layout.spacings);
  EXPECT_EQ(back.pair_rules, layout.pair_rules);
}

TEST_F(LayoutFile, GroupsThatMakeNoSenseAreNamedWithTheirLine) {
  const auto error = [&](const std::string& group, int line, ErrorKind kind) {
    return ErrorAtLine(line, "[[spacing]]", "[[group]]\n" + group + "\n[[spacing]]", kind);
  };
  EXPECT_TRUE(Mentions(error("name = \"g\"\nparts = [\"payload C\"]", 20, ErrorKind::kFormat),
                       "key 'parts' names no part: 'payload C'; did you mean 'payload A'?"));
  EXPECT_TRUE(Mentions(error("name = \"g\"\nparts = []", 20, ErrorKind::kRange), "has no parts"));
  EXPECT_TRUE(Mentions(error("name = \"g\"\n", 18, ErrorKind::kFormat), "key 'parts' is missing"));
  EXPECT_TRUE(Mentions(error("name = \"pmt box\"\nparts = [\"pmt box\"]", 19, ErrorKind::kRange),
                       "is named as the part"));
  EXPECT_TRUE(Mentions(error("name = \"g\"\nparts = [\"pmt box\", \"pmt box\"]", 20, ErrorKind::kRange),
                       "names part 'pmt box' twice"));
}

TEST_F(LayoutFile, ANodeIsOneInstanceOfAnAssemblyAndWhatHangsUnderIt) {
  const auto glb =
      testing::Gltf(core::testing::Box({0.1, 0.1, 0.1}),
                    {R"({"name":"bench","children":[1,2]})",
                     R"({"name":"lid","mesh":0,"translation":[1,0,0],"children":[3]})",
                     R"({"name":"lid 2","mesh":0})", R"({"name":"knob","mesh":0,"translation":[0,0,0.2]})"},
                    {0}, "");
  test_support::WriteText(folder_ / "parts/bench.glb", testing::Glb(glb));
  const auto with_node = [&](const std::string& node) {
    return Write("[[part]]\nname = \"all\"\nfile = \"parts/bench.glb\"\n" +
                 std::string("[[part]]\nname = \"one\"\nfile = \"parts/bench.glb\"\nnode = \"") + node +
                 "\"\n[[part]]\nname = \"twin\"\nfile = \"parts/bench.glb\"\nnode = \"" + node + "\"\n");
  };
  const core::Layout layout = ImportLayoutFile(with_node("bench/lid")).layout;
  EXPECT_EQ(layout.parts[0].mesh->triangles.size(), 36U);
  EXPECT_EQ(layout.parts[1].mesh->triangles.size(), 24U);
  EXPECT_EQ(layout.parts[1].mesh, layout.parts[2].mesh);
  const auto bounds = core::BoundsOf(*layout.parts[1].mesh);
  EXPECT_NEAR(bounds.center().x(), 1050.0, 1e-3) << "where the assembly has it";
  EXPECT_NEAR(bounds.sizes().z(), 300.0, 1e-3) << "with its knob";
  EXPECT_EQ(ImportLayoutFile(with_node("bench/lid/knob")).warnings.size(), 0U);
  WriteLayoutFile(layout, folder_ / "copy.toml");
  EXPECT_EQ(ImportLayoutFile(folder_ / "copy.toml").layout.parts[1].node, "bench/lid");
  const auto error = [&](const std::string& node) {
    return ErrorOf(ErrorKind::kFormat, [&] { (void)ImportLayoutFile(with_node(node)); });
  };
  EXPECT_TRUE(Mentions(error("bench/lit"),
                       "LAYOUT.toml:7: [[part]]: key 'node' 'bench/lit' is nothing in "
                       "parts/bench.glb; did you mean 'bench/lid'?"))
      << error("bench/lit");
  EXPECT_TRUE(Mentions(error("knob"), "did you mean 'bench/lid/knob'?")) << error("knob");
  EXPECT_TRUE(Mentions(error("engine"), "it has 'bench', 'bench/lid'")) << error("engine");
}

TEST_F(LayoutFile, InstancesOfOnePathAreTakenTogetherAndToldOf) {
  const auto glb = testing::Gltf(core::testing::Box({0.1, 0.1, 0.1}),
                                 {R"({"name":"bench","children":[1,2]})", R"({"name":"screw","mesh":0})",
                                  R"({"name":"screw","mesh":0,"translation":[1,0,0]})"},
                                 {0}, "");
  test_support::WriteText(folder_ / "parts/bench.glb", testing::Glb(glb));
  const ImportedLayout imported = ImportLayoutFile(
      Write("[[part]]\nname = \"one\"\nfile = \"parts/bench.glb\"\nnode = \"bench/screw\"\n"));
  EXPECT_EQ(imported.layout.parts[0].mesh->triangles.size(), 24U);
  ASSERT_EQ(imported.warnings.size(), 1U);
  EXPECT_TRUE(Mentions(imported.warnings[0], "2 instances are 'bench/screw'")) << imported.warnings[0];
}

TEST_F(LayoutFile, FilesThatAreNoLayoutAreErrors) {
  const auto message_of = [](ErrorKind kind, const std::filesystem::path& path) {
    return ErrorOf(kind, [&] { (void)ImportLayoutFile(path); });
  };
  EXPECT_TRUE(Mentions(message_of(ErrorKind::kFile, folder_ / "none.toml"), "no such layout file"));
  EXPECT_TRUE(Mentions(message_of(ErrorKind::kFile, folder_.path()), "isn't a file; name a layout file"));
  EXPECT_TRUE(
      Mentions(message_of(ErrorKind::kFormat, Write("unit = \"mm\"\n[[part]\n")), "LAYOUT.toml:2: not TOML"));
  EXPECT_TRUE(Mentions(message_of(ErrorKind::kFormat, Write("unit = \"mm\"\n")), "no [[part]]"));
  EXPECT_TRUE(Mentions(message_of(ErrorKind::kFormat, Write("part = 3\n")), "must be written as [[part]]"));
  EXPECT_TRUE(Mentions(message_of(ErrorKind::kFormat, Write("part = [3]\n")), "must be written as [[part]]"));
}

TEST_F(LayoutFile, WhatIsWrittenComesBack) {
  core::Layout layout = ImportLayoutFile(Write(kLayout)).layout;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> angle_deg(-180, 180), position_mm(-3000, 3000);
  for (int i = 0; i < 50; ++i) {
    core::Part part = layout.parts[0];
    part.name = "random \"" + std::to_string(i) + "\"";
    // Every fifth looks straight up or down, where roll and yaw can't be told apart.
    const double pitch_deg = i % 5 == 0 ? (i % 2 == 0 ? 90.0 : -90.0) : angle_deg(random);
    part.world_from_part =
        core::FromPositionAndRollPitchYaw({position_mm(random), position_mm(random), position_mm(random)},
                                          {angle_deg(random), pitch_deg, angle_deg(random)});
    layout.parts.push_back(part);
  }
  layout.spacings[0].initial_mm = 140.1;
  WriteLayoutFile(layout, folder_ / "copy.toml");
  const core::Layout back = ImportLayoutFile(folder_ / "copy.toml").layout;
  EXPECT_EQ(back.unit, layout.unit);
  ASSERT_EQ(back.parts.size(), layout.parts.size());
  for (std::size_t i = 0; i < layout.parts.size(); ++i) {
    EXPECT_EQ(back.parts[i].name, layout.parts[i].name);
    EXPECT_EQ(back.parts[i].file, layout.parts[i].file);
    EXPECT_EQ(back.parts[i].unit, layout.parts[i].unit);
    EXPECT_EQ(*back.parts[i].mesh, *layout.parts[i].mesh);
    EXPECT_EQ(back.parts[i].world_from_part.translation_mm, layout.parts[i].world_from_part.translation_mm);
    EXPECT_LT((back.parts[i].world_from_part.rotation - layout.parts[i].world_from_part.rotation).norm(),
              kRotationRounding);
  }
  EXPECT_EQ(back.spacings[0].initial_mm, 140.1);
  EXPECT_EQ(back.spacings[0].axis, core::Axis::kZ);
  EXPECT_EQ(back.pair_rules[0].required_clearance_mm, 5.0);
  EXPECT_TRUE(back.pair_rules[0].authorised_contact);
}

TEST_F(LayoutFile, WhatGivesWayComesBack) {
  core::Layout layout = ImportLayoutFile(Write(kLayout)).layout;
  core::ClothRule cloth;
  cloth.pins = {core::BoundsSide::kZMax, core::BoundsSide::kXMin};
  cloth.stretch_stiffness_n_per_m = 1234.5;
  cloth.friction = 0.75;
  layout.parts[0].gives_way = cloth;
  layout.parts[1].gives_way = core::PushRule{.max_speed_mm_per_s = 80.0};
  core::Stream stream;
  stream.name = "faucet";
  stream.position_mm = {1.0, 2.0, 300.0};
  stream.rate_per_s = 77.0;
  layout.streams = {stream};
  WriteLayoutFile(layout, folder_ / "copy.toml");
  const core::Layout back = ImportLayoutFile(folder_ / "copy.toml").layout;
  for (std::size_t i = 0; i < layout.parts.size(); ++i)
    EXPECT_EQ(back.parts[i].gives_way, layout.parts[i].gives_way) << i;
  EXPECT_EQ(back.streams, layout.streams);
}

TEST_F(LayoutFile, WhatCantGiveWaySaysWhy) {
  const std::string file = "file = \"parts/metres.glb\"\n";
  EXPECT_TRUE(Mentions(ErrorAtLine(17, file, file + "gives_way = \"jelly\"\n"),
                       "must be \"cloth\", \"pushed\" or \"none\""));
  EXPECT_TRUE(Mentions(ErrorAtLine(17, file, file + "friction = 0.5\n"), "goes with gives_way = \"cloth\""));
  EXPECT_TRUE(Mentions(ErrorAtLine(18, file, file + "gives_way = \"cloth\"\npins = [\"top\"]\n"),
                       "'top' is no side; use x_min"));
  const auto message_of = [&](const std::filesystem::path& path) {
    return ErrorOf(ErrorKind::kRange, [&] { (void)ImportLayoutFile(path); });
  };
  EXPECT_TRUE(Mentions(message_of(WriteWith(file, file + "gives_way = \"cloth\"\n")),
                       "part 'payload B': a cloth without pins falls off the table"));
  EXPECT_TRUE(
      Mentions(message_of(WriteWith(file, file + "gives_way = \"pushed\"\nmax_speed_mm_per_s = -1\n")),
               "part 'payload B': max_speed_mm_per_s must be from"));
  EXPECT_TRUE(
      Mentions(message_of(WriteWith("[[pair]]", "[[stream]]\nname = \"tap\"\nrate_per_s = 0\n[[pair]]")),
               "stream 'tap': rate_per_s must be from"));
}

TEST_F(LayoutFile, APartsWayOutOfTheHullArrivesAndComesBack) {
  const auto path = WriteWith("unit = \"in\"\n",
                              "reference_mm = [1, 2.5, -3]\nrecovery = \"hinge\"\n"
                              "recovery_axis = [0, 0, 2]\nrecovery_at_mm = [4, 5, 6]\n");
  const core::Layout layout = ImportLayoutFile(path).layout;
  EXPECT_EQ(layout.parts[0].recovery, core::RecoveryRule());
  const core::RecoveryRule hinge{core::RecoveryKind::kHinge, Eigen::Vector3d(1, 2.5, -3),
                                 Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(4, 5, 6)};
  EXPECT_EQ(layout.parts[1].recovery, hinge) << "in millimetres, whatever the part's unit";
  WriteLayoutFile(layout, folder_ / "copy.toml");
  const core::Layout back = ImportLayoutFile(folder_ / "copy.toml").layout;
  for (std::size_t i = 0; i < layout.parts.size(); ++i)
    EXPECT_EQ(back.parts[i].recovery, layout.parts[i].recovery);
}

TEST_F(LayoutFile, AWayOutThatMakesNoSenseIsNamedWithItsLine) {
  const auto message = [&](const std::string& keys) {
    return ErrorAtLine(12, "unit = \"in\"\n", keys + "\n");
  };
  EXPECT_TRUE(Mentions(message("recovery = \"sideways\""), "key 'recovery' must be \"reference\","));
  EXPECT_TRUE(
      Mentions(message("recovery = \"slider\""),
               "[[part]]: key 'recovery' (slider): a direction, slider or hinge needs an axis; add it"));
  EXPECT_TRUE(
      Mentions(message("recovery_axis = [0, 0, 1]"), "key 'recovery_axis' (reference): an axis has no"));
  EXPECT_TRUE(
      Mentions(message("recovery_at_mm = [0, 0, 1]"), "only a hinge has a point of its axis; remove it"));
  EXPECT_TRUE(Mentions(message("recovery = \"slider\"\nrecovery_axis = [0, 0, 0]"), "must not be zero"));
  EXPECT_TRUE(Mentions(message("reference_mm = [0, 0]"), "key 'reference_mm' must be three numbers"));
  EXPECT_TRUE(Mentions(message("recovery_axes = [0, 0, 1]"), "did you mean 'recovery_axis'?"));
}

TEST_F(LayoutFile, APartWithoutAFileCantBeWritten) {
  core::Layout layout = ImportLayoutFile(Write(kLayout)).layout;
  layout.parts[1].file.clear();
  EXPECT_TRUE(Mentions(ErrorOf(ErrorKind::kCad, [&] { WriteLayoutFile(layout, folder_ / "copy.toml"); }),
                       "part 'payload A' has no file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "copy.toml"));
}

}  // namespace
}  // namespace elbowroom::cad_import
