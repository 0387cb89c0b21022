#include "review/point_spread.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "core/error.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::review {
namespace {

using core::ContactPoint;
using Eigen::Vector3d;

std::vector<ContactPoint> RandomPoints(recon::Random* random, int count) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < count; ++i)
    points.push_back({100.0 * random->Direction(), random->Uniform(0, 5), random->Uniform(0.1, 2.0)});
  return points;
}

double TotalArea(const std::vector<ContactPoint>& points) {
  return std::accumulate(points.begin(), points.end(), 0.0,
                         [](double sum, const ContactPoint& point) { return sum + point.area_mm2; });
}

double NearestDistance(const std::vector<ContactPoint>& points, const Vector3d& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ContactPoint& point : points)
    nearest = std::min(nearest, (point.position_in_world_mm - x).norm());
  return nearest;
}

TEST(SpreadEvenly, KeepsFewPointsAsTheyAre) {
  recon::Random random(1);
  const std::vector<ContactPoint> points = RandomPoints(&random, 10);
  const std::vector<ContactPoint> kept = SpreadEvenly(points, 10);
  ASSERT_EQ(kept.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(kept[i].position_in_world_mm, points[i].position_in_world_mm);
    EXPECT_EQ(kept[i].area_mm2, points[i].area_mm2);
  }
  EXPECT_TRUE(SpreadEvenly(std::span<const ContactPoint>(), 3).empty());
}

TEST(SpreadEvenly, KeepsAreaDepthsAndCoversAll) {
  recon::Random random(2);
  const std::vector<ContactPoint> points = RandomPoints(&random, 2000);
  const std::vector<ContactPoint> kept = SpreadEvenly(points, 50);
  ASSERT_EQ(kept.size(), 50U);
  constexpr double kSumRounding = 1e-9;
  EXPECT_NEAR(TotalArea(kept), TotalArea(points), kSumRounding * TotalArea(points));
  // Farthest-point sampling: no point is farther from the kept than they are from each other.
  double closest_pair = std::numeric_limits<double>::infinity(), worst_cover = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const std::vector<ContactPoint> before(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(i));
    closest_pair = std::min(closest_pair, NearestDistance(before, kept[i].position_in_world_mm));
  }
  for (const ContactPoint& point : points)
    worst_cover = std::max(worst_cover, NearestDistance(kept, point.position_in_world_mm));
  EXPECT_LE(worst_cover, closest_pair);
  for (const ContactPoint& one : kept) {
    const auto original = std::ranges::find_if(points, [&](const ContactPoint& point) {
      return point.position_in_world_mm == one.position_in_world_mm;
    });
    ASSERT_NE(original, points.end());
    EXPECT_EQ(original->depth_mm, one.depth_mm);
  }
}

TEST(SpreadEvenly, DuplicatesLoseNoArea) {
  const std::vector<ContactPoint> points(20, {Vector3d(1, 2, 3), 1.0, 0.5});
  const std::vector<ContactPoint> kept = SpreadEvenly(points, 4);
  EXPECT_EQ(kept.size(), 4U);
  EXPECT_DOUBLE_EQ(TotalArea(kept), 10.0);
  EXPECT_THROW((void)SpreadEvenly(points, 0), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::review
