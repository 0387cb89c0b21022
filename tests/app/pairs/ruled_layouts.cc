#include "tests/app/pairs/ruled_layouts.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "app/control/pairs/ruled_pairs.h"
#include "tests/core/solids.h"

namespace elbowroom::control::testing {
namespace {

constexpr double kRoundingMm = 1e-9;

core::Part PartOf(std::string name, core::TriangleMesh mesh, const core::RigidTransform& world_from_part) {
  core::Part part;
  part.name = std::move(name);
  part.mesh = std::make_shared<const core::TriangleMesh>(std::move(mesh));
  part.world_from_part = world_from_part;
  return part;
}

}  // namespace

core::Layout StackOf(std::vector<review::testing::PartKind> kinds, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  core::Layout layout;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    core::RigidTransform pose = review::testing::AnyPose(random, 3.0);
    pose.translation_mm.x() += i % 2 == 0 ? 0.0 : 35.0;
    layout.parts.push_back(
        PartOf("part " + std::to_string(i), review::testing::MakePart(kinds[i], random), pose));
  }
  for (std::size_t i = 0; i + 2 < kinds.size(); i += 2)
    layout.groups.push_back(
        {"group " + std::to_string(i / 2), {layout.parts[i].name, layout.parts[i + 1].name}});
  for (std::size_t i = 0; i + 1 < layout.groups.size(); ++i)
    layout.spacings.push_back({"gap " + std::to_string(i), layout.groups[i + 1].name, layout.groups[i].name,
                               core::Axis::kZ, -10.0, 40.0, 10.0});
  for (std::size_t a = 0; a < kinds.size(); ++a)
    for (std::size_t b = a + 1; b < kinds.size(); ++b)
      layout.pair_rules.push_back(
          {layout.parts[a].name, layout.parts[b].name, 20.0 * any(random), any(random) < 0.2});
  layout.Validate();
  return layout;
}

std::vector<double> NextGaps(const core::Layout& layout, const std::vector<double>& last,
                             std::mt19937_64& random) {
  std::vector<double> gaps_mm = last;
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (std::size_t i = 0; i < gaps_mm.size(); ++i) {
    const core::Spacing& spacing = layout.spacings[i];
    if (any(random) < 0.4) gaps_mm[i] = spacing.min_mm + any(random) * (spacing.max_mm - spacing.min_mm);
  }
  return gaps_mm;
}

review::ClashReport JudgedAnew(const core::Layout& layout, const std::vector<double>& gaps_mm) {
  review::ClashChecker checker(layout, RuledPairsOf(layout));
  return checker.Check(core::PosesAt(layout, gaps_mm));
}

void ExpectSame(const std::vector<review::PairClash>& pairs, const std::vector<review::PairClash>& anew) {
  ASSERT_EQ(pairs.size(), anew.size());
  for (std::size_t i = 0; i < anew.size(); ++i) {
    EXPECT_EQ(pairs[i].verdict, anew[i].verdict);
    EXPECT_EQ(pairs[i].contained, anew[i].contained);
    EXPECT_NEAR(pairs[i].at_least_mm, anew[i].at_least_mm, kRoundingMm);
    ASSERT_EQ(pairs[i].gap.has_value(), anew[i].gap.has_value());
    if (!anew[i].gap) continue;
    EXPECT_NEAR(pairs[i].gap->distance_mm, anew[i].gap->distance_mm, kRoundingMm);
    EXPECT_NEAR((pairs[i].gap->on_a - pairs[i].gap->on_b).norm(), anew[i].gap->distance_mm, kRoundingMm);
  }
}

core::Layout ThreeBoxes() {
  const core::TriangleMesh box = core::testing::Box({50.0, 50.0, 50.0});
  core::Layout layout;
  layout.parts = {PartOf("lower", box, {}), PartOf("upper", box, {}), PartOf("aside", box, {})};
  layout.parts[2].world_from_part.translation_mm = {55.0, 0.0, 0.0};
  layout.spacings = {{"gap", "upper", "lower", core::Axis::kZ, 0.0, 400.0, 30.0}};
  layout.pair_rules = {{"lower", "upper", 20.0, false}, {"aside", "lower", 2.0, false}};
  layout.Validate();
  return layout;
}

}  // namespace elbowroom::control::testing
