#include "tests/accuracy/shape_costs.h"

#include <gtest/gtest.h>

#include <array>

namespace elbowroom::accuracy {
namespace {

constexpr TimingEffort kOnce{.repetitions = 1, .slow_repetitions = 1, .slow_ms = 1e9};

TEST(MeasureShapeCosts, BoundsHoldAndTheWorkHardlyGrowsWithTheTriangles) {
  const std::vector<ShapeCost> costs = MeasureShapeCosts(std::array{720, 28'320}, kOnce);
  ASSERT_EQ(costs.size(), 12U);
  for (std::size_t i = 0; i < costs.size(); i += 2) {
    const ShapeCost &few = costs[i], &many = costs[i + 1];
    SCOPED_TRACE(few.shape);
    ASSERT_EQ(few.shape, many.shape);
    EXPECT_NEAR(static_cast<double>(few.triangles), 720.0, 120.0);
    EXPECT_NEAR(static_cast<double>(many.triangles), 28'320.0, 600.0);
    for (const ShapeCost& cost : {few, many}) {
      EXPECT_TRUE(cost.is_certified);
      EXPECT_LE(cost.promised_mm, 1.0 + 1e-9);
      EXPECT_GE(cost.error_mm, -1e-2);
      EXPECT_LE(cost.error_mm, 1.0);
    }
    EXPECT_LT(many.queries, 3 * few.queries);
    EXPECT_LT(many.distances, 3 * few.distances);
  }
}

}  // namespace
}  // namespace elbowroom::accuracy
