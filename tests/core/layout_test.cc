#include "core/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "core/error.h"
#include "core/layout_fault.h"
#include "tests/core/solids.h"

namespace elbowroom::core {
namespace {

constexpr double kPlaceRoundingMm = 1e-10;  // a few double roundings on positions of a metre

Part BoxPart(const std::string& name, const Eigen::Vector3d& size_mm, const Eigen::Vector3d& position_mm,
             const Eigen::Vector3d& rpy_deg) {
  return {.name = name,
          .file = name + ".stl",
          .mesh = std::make_shared<const TriangleMesh>(testing::Box(size_mm)),
          .world_from_part = FromPositionAndRollPitchYaw(position_mm, rpy_deg)};
}

Spacing Gap(const std::string& name, const std::string& moving, const std::string& reference,
            Axis axis = Axis::kZ) {
  return {.name = name,
          .moving = moving,
          .reference = reference,
          .axis = axis,
          .min_mm = -50,
          .max_mm = 400,
          .initial_mm = 140};
}

Layout TwoTurnedParts() {
  Layout layout;
  layout.parts = {BoxPart("payload", {300, 200, 100}, {10, 20, 333}, {12, -34, 56}),
                  BoxPart("pmt", {250, 250, 400}, {-7, 3, 11}, {-80, 15, 140})};
  layout.spacings = {Gap("gap", "payload", "pmt")};
  return layout;
}

// Independent of ExtentAlong in the code: moves the whole mesh.
Eigen::AlignedBox3d WorldBounds(const Part& part, const RigidTransform& world_from_part) {
  return BoundsOf(*part.mesh, world_from_part);
}

TEST(PosesAt, GapBetweenTurnedPartsIsTheSpacingAlongEveryAxis) {
  for (const Axis axis : {Axis::kX, Axis::kY, Axis::kZ}) {
    Layout layout = TwoTurnedParts();
    layout.spacings[0].axis = axis;
    const auto i = static_cast<Eigen::Index>(axis);
    for (const double spacing_mm : {-50.0, 0.0, 140.0, 240.0, 399.9}) {
      const auto poses = PosesAt(layout, std::vector<double>{spacing_mm});
      const double gap_mm =
          WorldBounds(layout.parts[0], poses[0]).min()[i] - WorldBounds(layout.parts[1], poses[1]).max()[i];
      EXPECT_NEAR(gap_mm, spacing_mm, kPlaceRoundingMm) << ToString(axis);
      // Only the moving part moves, only along the axis, and it doesn't turn.
      EXPECT_EQ(poses[1], layout.parts[1].world_from_part);
      EXPECT_EQ(poses[0].rotation, layout.parts[0].world_from_part.rotation);
      for (Eigen::Index other = 0; other < 3; ++other) {
        if (other == i) continue;
        EXPECT_EQ(poses[0].translation_mm[other], layout.parts[0].world_from_part.translation_mm[other]);
      }
    }
  }
}

TEST(PosesAt, OutAndBackIsBitEqual) {
  const Layout layout = TwoTurnedParts();
  const auto before = PosesAt(layout, std::vector<double>{140.0});
  const auto opened = PosesAt(layout, std::vector<double>{240.0});
  const auto after = PosesAt(layout, std::vector<double>{140.0});
  EXPECT_EQ(before, after);
  EXPECT_NE(before, opened);
  EXPECT_NEAR(opened[0].translation_mm.z() - before[0].translation_mm.z(), 100.0, kPlaceRoundingMm);
}

TEST(PosesAt, ChainsCarryTheUpperPartsAlongInAnyOrderOfWriting) {
  Layout layout;
  layout.parts = {BoxPart("top", {10, 10, 10}, {0, 0, 900}, {0, 0, 0}),
                  BoxPart("middle", {10, 10, 20}, {0, 0, 500}, {0, 0, 30}),
                  BoxPart("base", {10, 10, 30}, {0, 0, 0}, {0, 0, 0})};
  layout.spacings = {Gap("upper", "top", "middle"),
                     Gap("lower", "middle", "base")};  // needs the second first
  const auto poses = PosesAt(layout, std::vector<double>{7.0, 5.0});
  EXPECT_NEAR(poses[1].translation_mm.z(), 35.0, kPlaceRoundingMm);
  EXPECT_NEAR(poses[0].translation_mm.z(), 62.0, kPlaceRoundingMm);
  std::swap(layout.spacings[0], layout.spacings[1]);
  EXPECT_EQ(PosesAt(layout, std::vector<double>{5.0, 7.0}), poses);
}

TEST(PosesAt, TwoAxesOfOnePartAreIndependent) {
  Layout layout = TwoTurnedParts();
  layout.spacings = {Gap("up", "payload", "pmt", Axis::kZ), Gap("side", "payload", "pmt", Axis::kX)};
  EXPECT_NO_THROW(layout.Validate());
  const auto poses = PosesAt(layout, std::vector<double>{100.0, 30.0});
  const Eigen::Vector3d gap_mm =
      WorldBounds(layout.parts[0], poses[0]).min() - WorldBounds(layout.parts[1], poses[1]).max();
  EXPECT_NEAR(gap_mm.z(), 100.0, kPlaceRoundingMm);
  EXPECT_NEAR(gap_mm.x(), 30.0, kPlaceRoundingMm);
}

Layout GroupAboveGroup() {
  Layout layout;
  layout.parts = {BoxPart("a", {10, 10, 10}, {0, 0, 100}, {0, 0, 0}),
                  BoxPart("b", {10, 10, 10}, {50, 0, 130}, {0, 45, 0}),
                  BoxPart("c", {10, 10, 10}, {0, 0, 0}, {0, 0, 0}),
                  BoxPart("d", {10, 10, 10}, {50, 0, 25}, {30, 0, 0})};
  layout.groups = {{"upper", {"a", "b"}}, {"lower", {"c", "d"}}};
  layout.spacings = {Gap("gap", "upper", "lower")};
  return layout;
}

TEST(PosesAt, AGroupEndsWhereItsFarthestPartDoesAndMovesAsOne) {
  const Layout layout = GroupAboveGroup();
  EXPECT_NO_THROW(layout.Validate());
  for (const double spacing_mm : {-50.0, 0.0, 240.0}) {
    const auto poses = PosesAt(layout, std::vector<double>{spacing_mm});
    Eigen::AlignedBox3d upper, lower;
    for (const PartIndex i : {0U, 1U}) upper.extend(WorldBounds(layout.parts[i], poses[i]));
    for (const PartIndex i : {2U, 3U}) lower.extend(WorldBounds(layout.parts[i], poses[i]));
    EXPECT_NEAR(upper.min().z() - lower.max().z(), spacing_mm, kPlaceRoundingMm);
    EXPECT_NEAR(GapMm(layout, layout.spacings[0], poses), spacing_mm, kPlaceRoundingMm);
    EXPECT_NEAR(poses[1].translation_mm.z() - poses[0].translation_mm.z(), 30.0, kPlaceRoundingMm);
    EXPECT_EQ(poses[2], layout.parts[2].world_from_part);
  }
}

TEST(PosesAt, WhatHangsOnAPartOfAGroupWaitsForTheGroup) {
  Layout layout = GroupAboveGroup();
  layout.parts.push_back(BoxPart("e", {10, 10, 10}, {0, 0, 500}, {0, 0, 0}));
  layout.spacings.insert(layout.spacings.begin(), Gap("on top", "e", "a"));
  const auto poses = PosesAt(layout, std::vector<double>{7.0, 240.0});
  EXPECT_NEAR(GapMm(layout, layout.spacings[0], poses), 7.0, kPlaceRoundingMm);
  EXPECT_NEAR(GapMm(layout, layout.spacings[1], poses), 240.0, kPlaceRoundingMm);
  layout.spacings.push_back(Gap("back", "c", "e"));
  EXPECT_EQ(FindLayoutFault(layout)->message.find("circular") != std::string::npos, true);
}

TEST(PairsOfParts, TheRuleThatNamesMorePartsHolds) {
  Layout layout = GroupAboveGroup();
  layout.pair_rules = {{"upper", "lower", 5.0, false},
                       {"a", "lower", 7.0, false},
                       {"c", "a", 9.0, true},
                       {"lower", "lower", 1.0, false}};
  const Layout of_parts = WithPairsOfParts(layout);
  const std::vector<PairRule> expected = {{"b", "c", 5.0, false},
                                          {"b", "d", 5.0, false},
                                          {"a", "d", 7.0, false},
                                          {"c", "a", 9.0, true},
                                          {"c", "d", 1.0, false}};
  EXPECT_EQ(of_parts.pair_rules, expected);
  layout.pair_rules = {{"a", "b", 1.0, false}, {"b", "a", 2.0, false}};
  EXPECT_EQ(WithPairsOfParts(layout).pair_rules, layout.pair_rules) << "contradictions aren't hidden";
}

// The definition: each gap in its order, from the places of all vertices.
std::vector<RigidTransform> PlacedOneByOne(const Layout& layout, const std::vector<double>& spacing_mm) {
  std::vector<RigidTransform> poses;
  for (const Part& part : layout.parts) poses.push_back(part.world_from_part);
  for (const SpacingIndex i : OrderOfPlacement(layout)) {
    const Spacing& spacing = layout.spacings[i];
    const auto axis = static_cast<Eigen::Index>(spacing.axis);
    const auto places_mm = [&](const std::string& name) {
      std::vector<double> all;
      for (const PartIndex part : layout.PartsNamed(name))
        for (const Eigen::Vector3d& vertex : layout.parts[part].mesh->vertices_mm)
          all.push_back(poses[part].rotation.row(axis).dot(vertex) + poses[part].translation_mm[axis]);
      return all;
    };
    const std::vector<double> reference = places_mm(spacing.reference), moving = places_mm(spacing.moving);
    const double shift_mm =
        *std::ranges::max_element(reference) + spacing_mm[i] - *std::ranges::min_element(moving);
    for (const PartIndex part : layout.PartsNamed(spacing.moving))
      poses[part].translation_mm[axis] += shift_mm;
  }
  return poses;
}

TEST(SpacingPoses, AreBitEqualToThoseOfAllVertices) {
  std::mt19937 random(20261127);
  std::uniform_real_distribution<double> place_mm(-2000.0, 2000.0), angle_deg(-180.0, 180.0),
      size_mm(0.01, 700.0), gap_mm(-50.0, 400.0);
  const auto three = [&random](auto& of) { return Eigen::Vector3d(of(random), of(random), of(random)); };
  for (int trial = 0; trial < 300; ++trial) {
    Layout layout = GroupAboveGroup();
    layout.parts.push_back(BoxPart("e", {10, 10, 10}, {0, 0, 500}, {0, 0, 0}));
    for (Part& part : layout.parts)
      part = BoxPart(part.name, three(size_mm), three(place_mm), three(angle_deg));
    layout.spacings = {Gap("on top", "e", "a", static_cast<Axis>(trial % 3)), layout.spacings[0],
                       Gap("side", "upper", "d", Axis::kX)};
    const SpacingPoses poses(layout);
    for (int i = 0; i < 3; ++i) {
      const std::vector<double> spacing_mm = {gap_mm(random), gap_mm(random), gap_mm(random)};
      EXPECT_EQ(poses.At(spacing_mm), PlacedOneByOne(layout, spacing_mm)) << "trial " << trial;
    }
  }
}

TEST(PosesAt, NeedsOneValueASpacing) { EXPECT_THROW((void)PosesAt(TwoTurnedParts(), {}), PreconditionError); }

struct BadLayout {
  const char* what;
  std::function<void(Layout&)> spoil;
  const char* expected;
};

TEST(LayoutValidate, NamesWhatIsWrong) {
  const BadLayout kCases[] = {
      {"nameless part", [](Layout& l) { l.parts[0].name = ""; }, "has no name"},
      {"same part name", [](Layout& l) { l.parts[0].name = "pmt"; }, "two parts are named 'pmt'"},
      {"no mesh", [](Layout& l) { l.parts[0].mesh = nullptr; }, "part 'payload' has no mesh"},
      {"same spacing name", [](Layout& l) { l.spacings.push_back(l.spacings[0]); },
       "two spacings are named 'gap'"},
      {"unknown moving", [](Layout& l) { l.spacings[0].moving = "pyload"; },
       "spacing 'gap': no part is named 'pyload'"},
      {"unknown reference", [](Layout& l) { l.spacings[0].reference = "x"; }, "no part is named 'x'"},
      {"itself", [](Layout& l) { l.spacings[0].moving = "pmt"; },
       "spacing 'gap': a part can't move against itself"},
      {"initial outside", [](Layout& l) { l.spacings[0].initial_mm = 500; },
       "min_mm <= initial_mm <= max_mm"},
      {"limits swapped", [](Layout& l) { std::swap(l.spacings[0].min_mm, l.spacings[0].max_mm); },
       "spacing 'gap'"},
      {"NaN", [](Layout& l) { l.spacings[0].initial_mm = std::nan(""); }, "spacing 'gap'"},
      {"endless", [](Layout& l) { l.spacings[0].max_mm = std::numeric_limits<double>::infinity(); },
       "spacing 'gap'"},
      {"a hinge without an axis", [](Layout& l) { l.parts[1].recovery.kind = RecoveryKind::kHinge; },
       "part 'pmt': recovery: a direction, slider or hinge needs an axis"},
      {"one part, one axis", [](Layout& l) { l.spacings.push_back(Gap("again", "payload", "pmt")); },
       "spacing 'again': moves 'payload' along z, as spacing 'gap' does"},
      {"empty group",
       [](Layout& l) {
         l.groups = {{"g", {}}};
       },
       "group 'g' has no parts"},
      {"group of strangers",
       [](Layout& l) {
         l.groups = {{"g", {"nobody"}}};
       },
       "group 'g': no part is named 'nobody'"},
      {"group against its own part",
       [](Layout& l) {
         l.groups = {{"g", {"payload", "pmt"}}};
         l.spacings[0].moving = "g";
       },
       "a part can't move against itself"},
      {"circular", [](Layout& l) { l.spacings.push_back(Gap("back", "pmt", "payload")); }, "circular"},
      {"a line break in a name", [](Layout& l) { l.parts[1].name = "pm\nt"; }, "the name of part 2"},
      {"a pair of one",
       [](Layout& l) {
         l.pair_rules.push_back({"pmt", "pmt", 5.0, false});
       },
       "a part has no clearance to itself"},
      {"two rules",
       [](Layout& l) {
         l.pair_rules = {{"pmt", "payload", 5.0, false}, {"payload", "pmt", 5.0, false}};
       },
       "'payload' and 'pmt' have a rule already"},
      {"two rules by groups",
       [](Layout& l) {
         l.groups = {{"g", {"payload"}}, {"h", {"pmt"}}};
         l.pair_rules = {{"g", "pmt", 5.0, false}, {"payload", "h", 5.0, false}};
       },
       "by the [[pair]] 'g' and 'pmt'"},
      {"unknown in pair",
       [](Layout& l) {
         l.pair_rules.push_back({"pmt", "nobody", 5.0, false});
       },
       "'nobody'"},
  };
  EXPECT_NO_THROW(TwoTurnedParts().Validate());
  Layout closer = TwoTurnedParts();  // the rule of parts holds, whatever groups say
  closer.groups = {{"g", {"payload"}}, {"h", {"pmt"}}};
  closer.pair_rules = {
      {"g", "pmt", 5.0, false}, {"payload", "h", 5.0, false}, {"pmt", "payload", 1.0, false}};
  EXPECT_NO_THROW(closer.Validate());
  for (const BadLayout& bad : kCases) {
    Layout layout = TwoTurnedParts();
    bad.spoil(layout);
    try {
      layout.Validate();
      ADD_FAILURE() << bad.what << " passed";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kRange) << bad.what;
      EXPECT_NE(std::string(error.what()).find(bad.expected), std::string::npos) << error.what();
    }
  }
}

TEST(Layout, FindsByNameAndStartsAtInitialSpacings) {
  const Layout layout = TwoTurnedParts();
  EXPECT_EQ(layout.FindPart("pmt"), PartIndex{1});
  EXPECT_EQ(layout.FindPart("PMT"), std::nullopt);
  EXPECT_EQ(layout.FindSpacing("gap"), SpacingIndex{0});
  EXPECT_EQ(layout.FindSpacing(""), std::nullopt);
  EXPECT_EQ(layout.InitialSpacings(), std::vector<double>{140.0});
}

TEST(Axis, TextComesBackAsTheSameAxis) {
  for (const Axis axis : {Axis::kX, Axis::kY, Axis::kZ}) EXPECT_EQ(ParseAxis(ToString(axis)), axis);
  EXPECT_EQ(ParseAxis("Z"), std::nullopt);
}

}  // namespace
}  // namespace elbowroom::core
