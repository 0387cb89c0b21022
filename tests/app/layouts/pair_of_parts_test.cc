// What is proposed for two chosen parts.
#include "app/control/layout_editing/pair_of_parts.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "core/layout_fault.h"
#include "tests/app/layouts/box_file.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

core::Part BoxAt(const std::string& name, const Vector3d& size_mm, const Vector3d& low_mm) {
  core::Part part;
  part.name = name;
  part.file = name + ".stl";
  part.mesh = std::make_shared<const core::TriangleMesh>(test_support::BoxMesh(size_mm));
  part.world_from_part.translation_mm = low_mm;
  return part;
}

std::vector<core::RigidTransform> Poses(const core::Layout& layout) {
  return core::PosesAt(layout, layout.InitialSpacings());
}

TEST(ProposeSpacing, TakesTheAxisAndSideOfTheWidestGap) {
  core::Layout layout;
  layout.parts = {BoxAt("box", {100.0, 100.0, 50.0}, {0.0, 0.0, 0.0}),
                  BoxAt("lid", {100.0, 100.0, 10.0}, {0.0, 120.0, 190.0})};
  const core::Spacing spacing = ProposeSpacing(layout, Poses(layout), "lid", "box");
  EXPECT_EQ(spacing.axis, core::Axis::kZ);
  EXPECT_EQ(spacing.moving, "lid");
  EXPECT_EQ(spacing.reference, "box");
  EXPECT_DOUBLE_EQ(spacing.initial_mm, 140.0);
  EXPECT_DOUBLE_EQ(spacing.min_mm, 0.0);
  EXPECT_DOUBLE_EQ(spacing.max_mm, 250.0);
}

TEST(ProposeSpacing, OfPartsThatOverlapBeginsBelowZero) {
  core::Layout layout;
  layout.parts = {BoxAt("box", {100.0, 100.0, 50.0}, {0.0, 0.0, 0.0}),
                  BoxAt("lid", {100.0, 100.0, 10.0}, {0.0, 0.0, 47.0})};
  const core::Spacing spacing = ProposeSpacing(layout, Poses(layout), "box", "lid");
  EXPECT_EQ(spacing.moving, "lid");
  EXPECT_DOUBLE_EQ(spacing.initial_mm, -3.0);
  EXPECT_DOUBLE_EQ(spacing.min_mm, -10.0);
}

TEST(ProposeSpacing, LeavesOutWhatTheLayoutCannotHave) {
  core::Layout layout;
  layout.parts = {BoxAt("box", {100.0, 100.0, 50.0}, {0.0, 0.0, 0.0}),
                  BoxAt("lid", {100.0, 100.0, 10.0}, {0.0, 120.0, 190.0})};
  layout.spacings.push_back(ProposeSpacing(layout, Poses(layout), "box", "lid"));
  const core::Spacing second = ProposeSpacing(layout, Poses(layout), "box", "lid");
  EXPECT_NE(second.name, layout.spacings[0].name);
  EXPECT_EQ(second.axis, core::Axis::kY);
  layout.spacings.push_back(second);
  EXPECT_FALSE(core::FindLayoutFault(layout));
}

// Whatever two parts are chosen: what is proposed can be added, and moves nothing.
TEST(ProposeSpacing, CanBeAddedAndMovesNothing) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-200.0, 200.0), size(5.0, 150.0);
  for (int run = 0; run < 200; ++run) {
    core::Layout layout;
    for (const char* name : {"a", "b", "c"})
      layout.parts.push_back(BoxAt(name, {size(random), size(random), size(random)},
                                   {place(random), place(random), place(random)}));
    const std::vector<core::RigidTransform> before = Poses(layout);
    layout.spacings.push_back(ProposeSpacing(layout, before, "a", "c"));
    ASSERT_FALSE(core::FindLayoutFault(layout)) << run;
    const std::vector<core::RigidTransform> after = Poses(layout);
    for (std::size_t i = 0; i < before.size(); ++i)  // gaps are proposed to 1 micrometre
      EXPECT_LT((before[i].translation_mm - after[i].translation_mm).norm(), 0.00051);
  }
}

TEST(ProposePairRule, IsTheOneThatIsThere) {
  core::Layout layout;
  layout.parts = {BoxAt("box", {1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}),
                  BoxAt("lid", {1.0, 1.0, 1.0}, {0.0, 0.0, 9.0})};
  EXPECT_DOUBLE_EQ(ProposePairRule(layout, "box", "lid").required_clearance_mm, 5.0);
  core::PairRule rule;
  rule.a = "lid";
  rule.b = "box";
  rule.required_clearance_mm = 12.0;
  layout.pair_rules = {rule};
  EXPECT_EQ(ProposePairRule(layout, "box", "lid"), rule);
}

}  // namespace
}  // namespace elbowroom::control
