// The radii that limits allow, held to a search over all turns.
#include "recon/gauge/width_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

// The search is in steps of the turn, which moves a point at the end by 1e-4 mm.
constexpr double kSearchMm = 3e-4;

struct Truth {
  double radius_mm, shift_mm, turn;
};

std::vector<SidePoint> PointsOf(const Truth& truth, std::mt19937* random, double limit_mm) {
  std::uniform_real_distribution<double> along(-100.0, 100.0), noise(-limit_mm, limit_mm);
  std::vector<SidePoint> points;
  for (int i = 0; i < 60; ++i) {
    const int side = i % 2 == 0 ? 1 : -1;
    const double s = along(*random);
    points.push_back(
        {side, s, truth.radius_mm + side * (truth.shift_mm + truth.turn * s) + noise(*random), limit_mm});
  }
  return points;
}

// The widest and the narrowest radius at the turns of a fine grid; low > high: none is possible.
RadiusRange Searched(const std::vector<SidePoint>& points) {
  RadiusRange range{1e9, -1e9, 0.0};
  for (double turn = -0.05; turn <= 0.05; turn += 1e-6) {
    double low[2] = {-1e9, -1e9}, high[2] = {1e9, 1e9};
    for (const SidePoint& point : points) {
      const int k = point.side > 0 ? 0 : 1;
      const double offset = point.error_mm - point.side * turn * point.along_mm;
      low[k] = std::max(low[k], offset - point.limit_mm);
      high[k] = std::min(high[k], offset + point.limit_mm);
    }
    if (low[0] > high[0] || low[1] > high[1]) continue;
    range.low_mm = std::min(range.low_mm, 0.5 * (low[0] + low[1]));
    range.high_mm = std::max(range.high_mm, 0.5 * (high[0] + high[1]));
  }
  return range;
}

TEST(RadiiWithin, IsWhatASearchFinds) {
  std::mt19937 random(3);
  for (int draw = 0; draw < 12; ++draw) {
    const Truth truth{0.3 * draw - 1.0, 2.0 - 0.4 * draw, 0.002 * (draw - 5)};
    const std::vector<SidePoint> points = PointsOf(truth, &random, 0.5 + 0.1 * draw);
    const RadiusRange found = RadiiWithin(points), searched = Searched(points);
    EXPECT_EQ(found.excess_mm, 0.0);
    EXPECT_NEAR(found.low_mm, searched.low_mm, kSearchMm) << draw;
    EXPECT_NEAR(found.high_mm, searched.high_mm, kSearchMm) << draw;
    EXPECT_LE(found.low_mm, truth.radius_mm);
    EXPECT_GE(found.high_mm, truth.radius_mm);
  }
}

TEST(RadiiWithin, SaysByHowMuchTheLimitsAreTooSmall) {
  // Of four points, one is 0.9 beside the line of the others on its side: limits of 0.2 are short by what the
  // best line leaves.
  std::vector<SidePoint> points = {{1, -50, 0, 0.2},  {1, 0, 0.9, 0.2}, {1, 50, 0, 0.2},
                                   {-1, -50, 0, 0.2}, {-1, 0, 0, 0.2},  {-1, 50, 0, 0.2}};
  EXPECT_NEAR(RadiiWithin(points).excess_mm, 0.45 - 0.2, 1e-9);
  points[1].error_mm = 0.3;
  EXPECT_EQ(RadiiWithin(points).excess_mm, 0.0);
}

TEST(RadiiWithin, NeedsBothSides) {
  const std::vector<SidePoint> points = {{1, 0, 0, 1}, {1, 1, 0, 1}, {-1, 0, 0, 1}};
  EXPECT_THROW((void)RadiiWithin(points), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::recon
