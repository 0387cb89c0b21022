#include "recon/error_budget/normal_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/recon/scenes/random_scene.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-9;

TEST(NormalCone, OneNormalTakesItsShareOfTheDirection) {
  const std::vector<Vector3d> normals = {Vector3d::UnitX()};
  const ConeWeights straight = WeightsInCone(normals, Vector3d::UnitX());
  EXPECT_NEAR(straight.weights[0], 1.0, kRounding);
  EXPECT_NEAR(straight.residual, 0.0, kRounding);
  const ConeWeights aslant = WeightsInCone(normals, Vector3d(1.0, 1.0, 0.0).normalized());
  EXPECT_NEAR(aslant.weights[0], std::sqrt(0.5), kRounding);
  EXPECT_NEAR(aslant.residual, std::sqrt(0.5), kRounding);
  const ConeWeights behind = WeightsInCone(normals, -Vector3d::UnitX());
  EXPECT_EQ(behind.weights[0], 0.0);
  EXPECT_EQ(behind.residual, 1.0);
}

TEST(NormalCone, AnEdgeSharesTheDirectionAmongItsTwoFaces) {
  // A wedge of 60 degrees: the normals are 120 degrees apart, and each weighs 1.
  const std::vector<Vector3d> normals = {{0.5, std::sqrt(0.75), 0.0}, {0.5, -std::sqrt(0.75), 0.0}};
  const ConeWeights cone = WeightsInCone(normals, Vector3d::UnitX());
  EXPECT_NEAR(cone.weights[0], 1.0, kRounding);
  EXPECT_NEAR(cone.weights[1], 1.0, kRounding);
  EXPECT_NEAR(cone.residual, 0.0, kRounding);
}

TEST(NormalCone, NoNormalsExplainNothing) { EXPECT_EQ(WeightsInCone({}, Vector3d::UnitX()).residual, 1.0); }

TEST(NormalCone, NoOtherWeightsComeNearer) {
  Random random(8101);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vector3d> normals;
    for (int i = random.Whole(1, 6); i > 0; --i) normals.push_back(random.Direction());
    const Vector3d direction = random.Direction();
    const ConeWeights cone = WeightsInCone(normals, direction);
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      ASSERT_GE(cone.weights[i], 0.0);
      sum += cone.weights[i] * normals[i];
    }
    EXPECT_NEAR((direction - sum).norm(), cone.residual, kRounding);
    // The conditions of Karush, Kuhn and Tucker: the rest leads into no half space of a normal, and is at a
    // right angle to those in use.
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const double slope = normals[i].dot(direction - sum);
      EXPECT_LE(slope, 1e-6);
      if (cone.weights[i] > 0.0) {
        EXPECT_NEAR(slope, 0.0, 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace elbowroom::recon
