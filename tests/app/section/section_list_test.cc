// Section planes while they are changed: angles, sides, outlines, steps back; saved in a layout's file.
#include "app/control/section/section_list.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "app/control/layout_editing/layout_document.h"
#include "app/control/layout_editing/section_file.h"
#include "core/error.h"
#include "tests/recon/scenes/random_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using test_support::ReadText;
using test_support::WriteText;

constexpr double kRounding = 1e-12;

TEST(PlaneAngles, AreThoseOfTheNormalAndGiveItBack) {
  EXPECT_EQ(NormalAt({90.0, 0.0}), Vector3d::UnitY());
  EXPECT_EQ(NormalAt({180.0, 0.0}), Vector3d(-1, 0, 0));
  EXPECT_EQ(NormalAt({30.0, 90.0}), Vector3d::UnitZ());
  EXPECT_EQ(NormalAt({0.0, -90.0}), Vector3d(0, 0, -1));
  const PlaneAngles angles = AnglesOf({-1.0, -1.0, std::sqrt(2.0)});
  EXPECT_NEAR(angles.azimuth_deg, -135.0, kRounding * 360);
  EXPECT_NEAR(angles.elevation_deg, 45.0, kRounding * 360);
  recon::Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3d normal = random.Rotation() * Vector3d::UnitX();
    EXPECT_LT((NormalAt(AnglesOf(3.0 * normal)) - normal).norm(), kRounding);
  }
}

TEST(Section, FlippedTwiceIsBitEqualAndKeepsTheOtherSide) {
  const Section section{"a", {0.3, -0.0, 4.0}, 12.5, true};
  EXPECT_EQ(Flipped(Flipped(section)), section);
  const Vector3d x(100, 20, 3);
  EXPECT_NE(CutOf(std::vector{section}).Keeps(x), CutOf(std::vector{Flipped(section)}).Keeps(x));
}

// A plane on a face cuts nothing off, however its corners are rounded.
TEST(Section, AlignedToAFaceKeepsAllOfItsCorners) {
  recon::Random random(11);
  for (int i = 0; i < 200; ++i) {
    const core::RigidTransform world_from_face{
        random.Rotation(), random.PointIn({Vector3d::Constant(-900), Vector3d::Constant(900)})};
    const Vector3d corners[3] = {world_from_face * Vector3d(0, 0, 0), world_from_face * Vector3d(130, 10, 0),
                                 world_from_face * Vector3d(20, 90, 0)};
    const Section section = AlignedTo({}, world_from_face.rotation.col(2), corners[0]);
    for (const Vector3d& corner : corners) {
      const double beyond_mm = HalfSpaceOf(section).BeyondMm(corner);
      EXPECT_LE(beyond_mm, 1e-8);
      EXPECT_GE(beyond_mm, -2e-3);
    }
  }
}

TEST(OutlineIn, IsTheConvexPolygonInWhichThePlaneMeetsTheBox) {
  const Eigen::AlignedBox3d box(Vector3d::Constant(-50), Vector3d::Constant(50));
  const Vector3d diagonal = Vector3d::Ones().normalized();
  EXPECT_EQ(OutlineIn({diagonal, 0.0}, box).size(), 6U);
  EXPECT_EQ(OutlineIn({diagonal, 60.0}, box).size(), 3U);
  EXPECT_TRUE(OutlineIn({diagonal, 90.0}, box).empty());
  recon::Random random(3);
  for (int i = 0; i < 50; ++i) {
    const recon::HalfSpace plane{random.Rotation() * Vector3d::UnitZ(), random.Uniform(-40, 40)};
    const std::vector<Vector3d> outline = OutlineIn(plane, box);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vector3d &a = outline[k], &b = outline[(k + 1) % outline.size()],
                     &c = outline[(k + 2) % outline.size()];
      EXPECT_NEAR(plane.BeyondMm(a), 0.0, 1e-9);
      EXPECT_LE(box.exteriorDistance(a), 1e-9);
      EXPECT_GE((b - a).cross(c - b).dot(plane.outward), -1e-6);
    }
  }
}

// What is kept of a box, against its corners; and of a segment, against points along it.
TEST(SectionCut, BoxesAndSegmentsAreKeptAsTheirPointsAre) {
  recon::Random random(17);
  for (int i = 0; i < 300; ++i) {
    const Eigen::AlignedBox3d box(random.PointIn({Vector3d::Constant(-60), Vector3d::Constant(0)}),
                                  random.PointIn({Vector3d::Constant(1), Vector3d::Constant(60)}));
    SectionCut cut;
    for (int k = 0; k < 2; ++k)
      cut.kept.push_back({random.Rotation() * Vector3d::UnitX(), random.Uniform(-80, 80)});
    bool all = true;
    for (int c = 0; c < 8; ++c)
      all = all && cut.Keeps(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));
    EXPECT_EQ(KeptOf(cut, box) == BoxKept::kAll, all);
    const Eigen::AlignedBox3d around(Vector3d::Constant(-90), Vector3d::Constant(90));
    const Vector3d from = random.PointIn(around), to = random.PointIn(around);
    bool meets = false;
    for (int s = 0; s <= 1000; ++s) {
      const Vector3d x = from + s / 1000.0 * (to - from);
      meets = meets || (box.contains(x) && cut.Keeps(x));
    }
    EXPECT_TRUE(!meets || MeetsKept(cut, box, from, to));
    EXPECT_FALSE(meets && KeptOf(cut, box) == BoxKept::kNothing);
  }
}

TEST(SectionList, ADragIsOneStepBack) {
  const Section first{"a", {1, 0, 0}, 0.0, true};
  SectionList list({first});
  EXPECT_FALSE(list.CanUndo());
  for (const double offset_mm : {1.0, 2.0, 3.0}) list.Change({{"a", {1, 0, 0}, offset_mm, true}}, "drag a");
  list.EndStep();
  list.Change({{"a", {1, 0, 0}, 4.0, true}}, "drag a");
  list.EndStep();
  list.Change({});
  list.Undo();
  EXPECT_EQ(list.now().front().offset_mm, 4.0);
  list.Undo();
  EXPECT_EQ(list.now().front().offset_mm, 3.0);
  list.Undo();
  EXPECT_EQ(list.now(), std::vector{first});
  EXPECT_FALSE(list.CanUndo());
  list.Redo();
  EXPECT_EQ(list.now().front().offset_mm, 3.0);
}

TEST(SectionList, GoesThroughSettingsUnchanged) {
  const std::vector<Section> sections = {{"Across X", {1, 0, 0}, 12.5, false},
                                         {"schräg \"1\"", {0.1, 0.2, -0.7}, -3e-4, true}};
  EXPECT_EQ(SectionsFrom(TextOf(sections)), sections);
  EXPECT_TRUE(SectionsFrom("").empty());
  EXPECT_TRUE(SectionsFrom("[[section]]\nname = 3").empty());
  EXPECT_EQ(FreeSectionName(sections, "Across X"), "Across X 2");
  EXPECT_EQ(FreeSectionName(sections, "Across Y"), "Across Y");
}

class SectionFile : public testing::Test {
 protected:
  SectionFile() { WriteText(file_, kLayout); }

  static constexpr const char* kLayout = "# Bench.\nunit = \"mm\"  # all of it\n";
  test_support::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "layout.toml";
  const std::vector<Section> sections_ = {{"lid", {0, 0, 1}, 140.0, true}};
};

TEST_F(SectionFile, GetsTheSectionsAndKeepsTheRest) {
  SaveSections(file_, sections_);
  EXPECT_TRUE(ReadText(file_).starts_with(kLayout));
  EXPECT_EQ(cad_import::SectionsOf(cad_import::LayoutText::Read(file_)), sections_);
  SaveSections(file_, {});
  EXPECT_EQ(ReadText(file_), kLayout);
  EXPECT_THROW(SaveSections(folder_ / "none.toml", sections_), core::Error);
}

// The layout page has the file open while the trial page saves planes into it.
TEST_F(SectionFile, SavedMeanwhileAreNoReasonToRefuseALayoutsChanges) {
  LayoutDocument document = LayoutDocument::Open(file_);
  document.Apply("Unit", [](cad_import::LayoutText& text) { text.SetUnit(core::LengthUnit::kInch); });
  SaveSections(file_, sections_);
  document.Save();
  const cad_import::LayoutText saved = cad_import::LayoutText::Read(file_);
  EXPECT_EQ(saved.unit(), core::LengthUnit::kInch);
  EXPECT_EQ(cad_import::SectionsOf(saved), sections_);
  EXPECT_FALSE(document.is_changed());
  document.Undo();
  EXPECT_EQ(cad_import::SectionsOf(document.text()), sections_);
  // Anything else is.
  WriteText(file_, std::string(kLayout) + "# of another program\n");
  EXPECT_THROW(document.Save(), core::Error);
}

}  // namespace
}  // namespace elbowroom::control
