#include "tests/oracles/solid_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "recon/synthetic/actors.h"
#include "tests/core/solids.h"
#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::oracles {
namespace {

using core::RigidTransform;
using Eigen::Vector3d;

constexpr double kToleranceMm = 0.01;
constexpr double kFarMm = 200.0;

recon::Solid BallAt(const Vector3d& center, double radius_mm) {
  return {recon::Sphere{radius_mm}, {Eigen::Matrix3d::Identity(), center}};
}

double DistanceMm(const core::TriangleMesh& part, const std::vector<recon::Solid>& solids,
                  const RigidTransform& world_from_part = {}) {
  return SolidDistanceMm(part, world_from_part, solids, kToleranceMm, kFarMm);
}

TEST(SolidDistance, IsThatOfClosedForms) {
  const core::TriangleMesh box = core::testing::Box({100.0, 80.0, 60.0});
  EXPECT_NEAR(DistanceMm(box, {BallAt({50.0, 40.0, 100.0}, 25.0)}), 15.0, kToleranceMm) << "above a face";
  EXPECT_NEAR(DistanceMm(box, {BallAt({103.0, 84.0, 30.0}, 2.0)}), 3.0, kToleranceMm) << "beside an edge";
  EXPECT_NEAR(DistanceMm(box, {BallAt({50.0, 40.0, 80.0}, 25.0)}), -5.0, kToleranceMm) << "5 mm deep";
  EXPECT_NEAR(DistanceMm(box, {BallAt({50.0, 40.0, 30.0}, 10.0)}), -20.0, kToleranceMm) << "inside";
  EXPECT_GE(DistanceMm(box, {BallAt({50.0, 40.0, 900.0}, 10.0)}), kFarMm) << "far away";
}

TEST(SolidDistance, IsNeverBelowNorFarAboveThatOfDenseSamples) {
  recon::Random random(7);
  const core::TriangleMesh box = core::testing::Box({90.0, 60.0, 40.0});
  for (int i = 0; i < 40; ++i) {
    const RigidTransform world_from_part{random.Rotation(), 160.0 * random.Direction()};
    const recon::SyntheticObject hand =
        recon::Hand({random.Rotation(), Vector3d::Zero()}, recon::OpenHand(), {-150.0, 0.0, 0.0});
    double sampled_mm = 1e9;
    for (const auto& triangle : box.triangles) {
      const auto corner = [&](std::size_t k) -> Vector3d {
        return world_from_part * box.vertices_mm[static_cast<std::size_t>(triangle[k])];
      };
      constexpr int kSteps = 90;
      for (int u = 0; u <= kSteps; ++u)
        for (int v = 0; u + v <= kSteps; ++v) {
          const Vector3d x =
              corner(0) + (u * (corner(1) - corner(0)) + v * (corner(2) - corner(0))) / double{kSteps};
          for (const recon::Solid& solid : hand.solids)
            sampled_mm = std::min(sampled_mm, recon::SignedDistanceMm(solid, x));
        }
    }
    constexpr double kSampleMm = 1.3;  // the longest side over the steps, to the nearest sample
    const double found_mm = DistanceMm(box, hand.solids, world_from_part);
    EXPECT_LE(std::abs(found_mm), std::abs(sampled_mm) + kSampleMm);
    EXPECT_LE(found_mm, sampled_mm + kToleranceMm);
    EXPECT_GE(found_mm, sampled_mm - kSampleMm);
  }
}

}  // namespace
}  // namespace elbowroom::oracles
