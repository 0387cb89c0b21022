// Virtual parts against each other at the spacings that a trial had.
#include "app/control/report/pair_approaches.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace elbowroom::tests {
namespace {

constexpr double kPeriod_s = 0.1;

core::SharedMesh UnitBox(double side_mm) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.emplace_back((i & 1) * side_mm, ((i >> 1) & 1) * side_mm, ((i >> 2) & 1) * side_mm);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return std::make_shared<const core::TriangleMesh>(std::move(mesh));
}

// Boxes of 50 mm, the upper one above the lower one by the gap; they must keep 20 mm apart.
core::Layout TwoBoxes() {
  core::Layout layout;
  for (const char* name : {"lower", "upper"}) {
    core::Part part;
    part.name = name;
    part.mesh = UnitBox(50.0);
    layout.parts.push_back(part);
  }
  core::Spacing gap;
  gap.name = "gap";
  gap.moving = "upper";
  gap.reference = "lower";
  gap.axis = core::Axis::kZ;
  gap.min_mm = 0.0;
  gap.max_mm = 400.0;
  gap.initial_mm = 30.0;
  layout.spacings.push_back(gap);
  layout.pair_rules.push_back({"lower", "upper", 20.0, false});
  return layout;
}

std::vector<sessions::FrameSummary> FramesAt(const std::vector<double>& gaps_mm) {
  std::vector<sessions::FrameSummary> frames;
  for (const double gap_mm : gaps_mm)
    frames.push_back({static_cast<core::FrameIndex>(frames.size()),
                      kPeriod_s * static_cast<double>(frames.size()),
                      {gap_mm}});
  return frames;
}

sessions::PairApproaches ApproachesAt(const core::Layout& layout, const std::vector<double>& gaps_mm) {
  return control::PairApproachesOf(layout, FramesAt(gaps_mm), {});
}

TEST(PairApproaches, JudgeEachSettingOnce) {
  const sessions::PairApproaches found = ApproachesAt(TwoBoxes(), {30, 30, 12, 12, 12, 30, 40});
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs.front().required_mm, 20.0);
  EXPECT_EQ(found.settings, 3U);
  ASSERT_EQ(found.judged.size(), 3U);
  for (const double gap_mm : {12.0, 30.0, 40.0}) {
    const sessions::PairSetting* setting = found.Find({gap_mm});
    ASSERT_NE(setting, nullptr);
    const sessions::PairDistance& distance = setting->distances.at(0);
    EXPECT_EQ(distance.verdict, gap_mm < 20.0 ? core::Verdict::kNear : core::Verdict::kClear);
    EXPECT_LE(distance.at_least_mm, gap_mm + 1e-9);
    EXPECT_NEAR(distance.gap_mm.value_or(gap_mm), gap_mm, 1e-9);
  }
  EXPECT_TRUE(found.Find({12.0})->distances[0].gap_mm.has_value());
  EXPECT_EQ(found.Find({13.0}), nullptr);
}

TEST(PairApproaches, TellWhereContactIsAllowed) {
  core::Layout layout = TwoBoxes();
  layout.pair_rules.front().authorised_contact = true;
  const sessions::PairApproaches found = ApproachesAt(layout, {30, 0, 0});
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_TRUE(found.pairs.front().authorised_contact);
  EXPECT_EQ(found.Find({0.0})->distances.at(0).verdict, core::Verdict::kContact);
}

TEST(PairApproaches, OfASliderTakeTheExtremes) {
  std::vector<double> gaps_mm(50, 100.0);
  for (double gap_mm = 300.0; gap_mm > 5.0; gap_mm -= 0.5) gaps_mm.push_back(gap_mm);
  const sessions::PairApproaches found = ApproachesAt(TwoBoxes(), gaps_mm);
  EXPECT_EQ(found.settings, 590U);
  EXPECT_LE(found.judged.size(), control::kMostSettings + 2);
  ASSERT_NE(found.Find({5.5}), nullptr);
  EXPECT_NEAR(found.Find({5.5})->distances.at(0).gap_mm.value(), 5.5, 1e-9);
  EXPECT_NE(found.Find({300.0}), nullptr);
  EXPECT_NE(found.Find({100.0}), nullptr) << "it was held longest";
}

TEST(PairApproaches, NeedARuleAndAFrame) {
  core::Layout layout = TwoBoxes();
  EXPECT_TRUE(ApproachesAt(layout, {}).pairs.empty());
  layout.pair_rules.front().ignore = true;
  EXPECT_TRUE(ApproachesAt(layout, {30}).pairs.empty());
  layout.pair_rules.clear();
  EXPECT_TRUE(ApproachesAt(layout, {30}).pairs.empty());
}

}  // namespace
}  // namespace elbowroom::tests
