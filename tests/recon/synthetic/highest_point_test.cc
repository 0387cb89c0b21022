// The highest point of a solid above a rectangle, against rays from above.
#include "recon/synthetic/highest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

namespace elbowroom::recon {
namespace {

using Eigen::AlignedBox2d, Eigen::Vector2d, Eigen::Vector3d;

class RandomSolids {
 public:
  double Between(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Vector3d Direction() {
    std::normal_distribution<double> normal;
    return Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  core::RigidTransform Transform() {
    return {Eigen::AngleAxisd(Between(0.0, std::numbers::pi), Direction()).toRotationMatrix(),
            {Between(-30.0, 30.0), Between(-30.0, 30.0), Between(-30.0, 30.0)}};
  }
  Solid AnySolid(int kind) {
    Solid solid;
    solid.world_from_solid = Transform();
    if (kind == 0) solid.shape = Sphere{Between(2.0, 20.0)};
    if (kind == 1) solid.shape = Capsule{Between(2.0, 15.0), Between(1.0, 60.0)};
    if (kind == 2) solid.shape = Tube{Between(2.0, 20.0), 0.0, Between(1.0, 60.0)};
    if (kind == 3) solid.shape = Box{{Between(2.0, 50.0), Between(2.0, 50.0), Between(2.0, 50.0)}};
    return solid;
  }

 private:
  std::mt19937_64 engine_{17};
};

// The highest of what vertical rays through a grid of the rectangle meet, its border included.
std::optional<double> HighestByRays(const Solid& solid, const AlignedBox2d& above) {
  constexpr int kAcross = 120;
  constexpr double kOverZMm = 200.0;
  std::optional<double> highest;
  for (int i = 0; i <= kAcross; ++i) {
    for (int k = 0; k <= kAcross; ++k) {
      const Vector2d at =
          above.min() + Vector2d(above.sizes().x() * i / kAcross, above.sizes().y() * k / kAcross);
      const auto hit = FirstHit(solid, Ray{{at.x(), at.y(), kOverZMm}, -Vector3d::UnitZ()});
      if (hit) highest = std::max(highest.value_or(-kOverZMm), kOverZMm - hit->distance_mm);
    }
  }
  return highest;
}

TEST(HighestPoint, IsThatWhichRaysFromAboveMeet) {
  // A grid of half a millimetre misses the very top of steep solids.
  constexpr double kGridMissesMm = 2.0, kRoundingMm = 1e-9;
  RandomSolids random;
  int above_some = 0;
  for (int trial = 0; trial < 240; ++trial) {
    const Solid solid = random.AnySolid(trial % 4);
    const Vector2d corner(random.Between(-50.0, 20.0), random.Between(-50.0, 20.0));
    const AlignedBox2d above(corner, corner + Vector2d(random.Between(5.0, 60.0), random.Between(5.0, 60.0)));
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    const auto found = HighestZMm(solid, above), by_rays = HighestByRays(solid, above);
    if (!by_rays) continue;  // at most a sliver between two rays
    ASSERT_TRUE(found);
    EXPECT_GE(*found, *by_rays - kRoundingMm);
    EXPECT_LE(*found, *by_rays + kGridMissesMm);
    ++above_some;
  }
  EXPECT_GT(above_some, 100);
}

TEST(HighestPoint, IsExactWhereItIsKnown) {
  const AlignedBox2d wide(Vector2d(-100.0, -100.0), Vector2d(100.0, 100.0));
  const AlignedBox2d beside(Vector2d(6.0, -100.0), Vector2d(100.0, 100.0));
  Solid solid;
  solid.world_from_solid.translation_mm = {0.0, 0.0, 40.0};
  solid.shape = Sphere{10.0};
  EXPECT_DOUBLE_EQ(*HighestZMm(solid, wide), 50.0);
  EXPECT_DOUBLE_EQ(*HighestZMm(solid, beside), 48.0) << "6, 8, 10";
  solid.shape = Capsule{10.0, 30.0};
  EXPECT_NEAR(*HighestZMm(solid, beside), 78.0, 1e-9);
  solid.shape = Box{{20.0, 20.0, 10.0}};
  EXPECT_DOUBLE_EQ(*HighestZMm(solid, beside), 45.0);
  const AlignedBox2d far_away(Vector2d(11.0, -100.0), Vector2d(100.0, 100.0));
  solid.shape = Sphere{10.0};
  EXPECT_FALSE(HighestZMm(solid, far_away));
  EXPECT_FALSE(HighestZMm(std::span<const SyntheticObject>(), wide));
}

}  // namespace
}  // namespace elbowroom::recon
