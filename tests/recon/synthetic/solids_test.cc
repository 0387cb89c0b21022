// Ray hits and signed distances of the analytic solids against each other and against closed forms.
#include "recon/synthetic/solids.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kExactMm = 1e-7;  // rounding over a few hundred millimetres, with room for a square root

class Randomness {
 public:
  double Between(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
  Vector3d Point(double half_mm) {
    return {Between(-half_mm, half_mm), Between(-half_mm, half_mm), Between(-half_mm, half_mm)};
  }
  Vector3d Direction() {
    std::normal_distribution<double> normal;
    return Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  core::RigidTransform Transform() {
    return {Eigen::AngleAxisd(Between(0.0, 3.0), Direction()).toRotationMatrix(), Point(30.0)};
  }
  Solid AnySolid() {
    Solid solid;
    solid.world_from_solid = Transform();
    switch (std::uniform_int_distribution(0, 4)(engine_)) {
      case 0:
        solid.shape = Sphere{Between(1.0, 40.0)};
        break;
      case 1:
        solid.shape = Capsule{Between(1.0, 20.0), Between(1.0, 80.0)};
        break;
      case 2:
        solid.shape = Tube{Between(15.0, 30.0), Between(2.0, 14.0), Between(10.0, 90.0)};
        break;
      case 3:
        solid.shape = Tube{Between(5.0, 30.0), 0.0, Between(10.0, 90.0)};
        break;
      default:
        solid.shape = Box{Vector3d(Between(5.0, 60.0), Between(5.0, 60.0), Between(5.0, 60.0))};
    }
    return solid;
  }

 private:
  std::mt19937_64 engine_{20260501};
};

TEST(SyntheticSolids, AHitLiesOnTheSurfaceAndNothingLiesBeforeIt) {
  Randomness random;
  constexpr double kReachMm = 300.0;
  constexpr double kStepMm = 0.5;
  int hits = 0;
  int from_inside = 0;
  for (int i = 0; i < 3000; ++i) {
    const Solid solid = random.AnySolid();
    const Vector3d origin_in_world = random.Point(100.0);
    const Ray ray{origin_in_world, (random.Point(50.0) - origin_in_world).normalized()};
    const double at_origin_mm = SignedDistanceMm(solid, ray.origin_in_world);
    const auto hit = FirstHit(solid, ray);
    const double end_mm = hit ? hit->distance_mm : kReachMm;
    for (double t = 0.0; t < std::min(end_mm - kExactMm, kReachMm); t += kStepMm) {
      const double distance_mm = SignedDistanceMm(solid, ray.origin_in_world + t * ray.direction_in_world);
      ASSERT_GE(distance_mm * (at_origin_mm < 0.0 ? -1.0 : 1.0), -kExactMm) << "case " << i << " at " << t;
    }
    if (!hit) {
      ASSERT_GT(at_origin_mm, 0.0) << "a ray from inside leaves";
      continue;
    }
    ++hits;
    from_inside += at_origin_mm < 0.0;
    const Vector3d x_in_world = ray.origin_in_world + hit->distance_mm * ray.direction_in_world;
    ASSERT_NEAR(SignedDistanceMm(solid, x_in_world), 0.0, kExactMm);
    ASSERT_NEAR(hit->normal_in_world.norm(), 1.0, 1e-9);
    // The normal points out: a little way along it the distance grows by as much.
    constexpr double kOutMm = 1e-3;
    ASSERT_NEAR(SignedDistanceMm(solid, x_in_world + kOutMm * hit->normal_in_world), kOutMm, 1e-6);
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(from_inside, 20);
}

TEST(SyntheticSolids, TheSignedDistanceIsReachedAndNeverExceeded) {
  Randomness random;
  for (int i = 0; i < 2000; ++i) {
    const Solid solid = random.AnySolid();
    const Vector3d x_in_world = random.Point(120.0);
    const double distance_mm = std::abs(SignedDistanceMm(solid, x_in_world));
    double nearest_mm = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 60; ++k) {
      const auto hit = FirstHit(solid, {x_in_world, random.Direction()});
      if (hit) nearest_mm = std::min(nearest_mm, hit->distance_mm);
    }
    ASSERT_GE(nearest_mm, distance_mm - kExactMm) << "case " << i;
    // Down the gradient the surface is exactly that far.
    constexpr double kDifferenceMm = 1e-5;
    Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step = kDifferenceMm * Vector3d::Unit(axis);
      gradient[axis] =
          (SignedDistanceMm(solid, x_in_world + step) - SignedDistanceMm(solid, x_in_world - step)) /
          (2.0 * kDifferenceMm);
    }
    if (std::abs(gradient.norm() - 1.0) > 1e-4) continue;  // on the medial axis there is none
    const Vector3d foot_in_world = x_in_world - SignedDistanceMm(solid, x_in_world) * gradient.normalized();
    ASSERT_NEAR(SignedDistanceMm(solid, foot_in_world), 0.0, 1e-2) << "case " << i;
  }
}

TEST(SyntheticSolids, AnOpenTubeIsEmptyAlongItsAxisAndHasTheVolumeOfItsWall) {
  const Solid tube{Tube{20.0, 18.0, 140.0}, {}, Vector3d::Zero()};
  EXPECT_FALSE(FirstHit(tube, {{0.0, 0.0, -50.0}, Vector3d::UnitZ()}));
  EXPECT_FALSE(Contains(tube, {0.0, 0.0, 70.0}));
  EXPECT_TRUE(Contains(tube, {19.0, 0.0, 70.0}));
  const auto through_the_mouth = FirstHit(tube, {{0.0, 0.0, 200.0}, Vector3d(0.1, 0.0, -1.0).normalized()});
  ASSERT_TRUE(through_the_mouth);
  EXPECT_LT(through_the_mouth->normal_in_world.x(), -0.99) << "the bore's wall faces the axis";
  Randomness random;
  int inside = 0;
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) {
    inside += Contains(
        tube, {random.Between(-20.0, 20.0), random.Between(-20.0, 20.0), random.Between(0.0, 140.0)});
  }
  const double share = std::numbers::pi * (20.0 * 20.0 - 18.0 * 18.0) / (40.0 * 40.0);
  const double sigma = std::sqrt(share * (1.0 - share) / kSamples);
  EXPECT_NEAR(static_cast<double>(inside) / kSamples, share, 5.0 * sigma);
}

TEST(SyntheticSolids, TheBoundingSphereHoldsTheSurfaceAndTouchesIt) {
  Randomness random;
  for (int i = 0; i < 300; ++i) {
    const Solid solid = random.AnySolid();
    const BoundingSphere sphere = BoundingSphereOf(solid);
    for (int k = 0; k < 100; ++k) {
      const Vector3d outside = sphere.center_in_world + (sphere.radius_mm + 1.0) * random.Direction();
      ASSERT_GE(SignedDistanceMm(solid, outside), 1.0 - kExactMm);
    }
  }
  const BoundingSphere pipe = BoundingSphereOf({Tube{20.0, 18.0, 140.0}, {}, Vector3d::Zero()});
  EXPECT_NEAR((Vector3d(20.0, 0.0, 140.0) - pipe.center_in_world).norm(), pipe.radius_mm, kExactMm);
}

TEST(SyntheticSolids, CapsuleBetweenSpansItsPoints) {
  const Vector3d a(10.0, -20.0, 5.0);
  const Vector3d b(-30.0, 40.0, 60.0);
  const Solid capsule = CapsuleBetween(a, b, 7.0, Vector3d::Zero());
  EXPECT_NEAR(SignedDistanceMm(capsule, a), -7.0, kExactMm);
  EXPECT_NEAR(SignedDistanceMm(capsule, b), -7.0, kExactMm);
  EXPECT_NEAR(SignedDistanceMm(capsule, b + 9.0 * (b - a).normalized()), 2.0, kExactMm);
  EXPECT_THROW((void)CapsuleBetween(a, a, 7.0, Vector3d::Zero()), core::PreconditionError);
  EXPECT_TRUE(
      core::IsRotation(CapsuleBetween(a, a - Vector3d::UnitZ(), 1.0, a).world_from_solid.rotation, 1e-12));
}

}  // namespace
}  // namespace elbowroom::recon
