// The tables of judging, on a few poses.
#include "tests/accuracy/judging_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"

namespace elbowroom::accuracy {
namespace {

constexpr TimingEffort kOnce{.repetitions = 1, .slow_repetitions = 1, .slow_ms = 1e9};

const JudgingMethod& Find(const std::vector<JudgingMethod>& methods, const std::string& family,
                          const std::string& setting) {
  const auto found = std::ranges::find_if(methods, [&](const JudgingMethod& method) {
    return method.family.starts_with(family) && method.setting == setting;
  });
  core::Require(found != methods.end(), family + " has a setting " + setting);
  return *found;
}

TEST(CompareContactAreas, FinerIsMoreExactAndTheExactOneIsMoreExactThanViewports) {
  const std::vector<JudgingMethod> methods = CompareContactAreas(3, 7802, kOnce);
  const JudgingMethod& usual = Find(methods, "exact", "half a pixel");
  EXPECT_LT(usual.worst_error, 2.0);  // per cent; samples are good to some tenths
  EXPECT_EQ(usual.missed, 0);
  EXPECT_LT(usual.rms_error, Find(methods, "exact", "8 mm").rms_error);
  const JudgingMethod& viewports = Find(methods, "the paper's", "10 x 10");
  EXPECT_LT(usual.rms_error, viewports.rms_error);
  EXPECT_GT(viewports.rms_error, 0.1) << "two millimetres between samples can't be that good";
}

TEST(CompareClearances, KeepsWhatItPromises) {
  const std::vector<JudgingMethod> methods = CompareClearances(3, 7803, std::vector{8.0, 2.0}, kOnce);
  for (const JudgingMethod& method : methods) {
    if (method.family != "certified clearance") continue;
    EXPECT_LE(method.promised, std::stod(method.setting) + 1e-9) << method.setting;
    EXPECT_LE(method.worst_error, method.promised + 1e-3) << method.setting;
  }
  EXPECT_LT(Find(methods, "hull mesh", "edges of 2 mm").rms_error,
            Find(methods, "hull mesh", "edges of 8 mm").rms_error);
}

TEST(MeasureJudgingCosts, AsksOfTheSurfaceAndNotOfTheTriangles) {
  const std::vector<JudgingCost> costs = MeasureJudgingCosts(kOnce);
  ASSERT_EQ(costs.size(), 11U);
  EXPECT_EQ(costs[0].triangles, 720U);
  EXPECT_EQ(costs[4].triangles, 1'000'000U);
  EXPECT_EQ(costs[8].cameras, 8U);
  EXPECT_LT(costs[5].contact_area_mm2, costs[0].contact_area_mm2);
  EXPECT_GT(costs[6].contact_area_mm2, costs[0].contact_area_mm2);
  EXPECT_NEAR(costs[4].contact_area_mm2, costs[1].contact_area_mm2, 0.02 * costs[1].contact_area_mm2);
  EXPECT_LT(costs[4].contact_queries, 3 * costs[1].contact_queries);
  EXPECT_GT(costs[4].skipped_triangles, 0.9);
  EXPECT_LT(costs[9].hull_cm3, costs[0].hull_cm3);
  EXPECT_GT(costs[10].hull_cm3, costs[0].hull_cm3);
  for (const JudgingCost& cost : costs) EXPECT_GT(cost.clearance_queries, 0) << cost.what;
}

}  // namespace
}  // namespace elbowroom::accuracy
