#include "core/rigid_transform.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/error.h"

namespace elbowroom::core {
namespace {

constexpr double kRounding = 1e-12;   // a few double roundings on entries of size 1
constexpr double kRoundingMm = 1e-9;  // the same on positions of a few metres

RigidTransform RandomTransform(std::mt19937& random) {
  std::uniform_real_distribution<double> angle_deg(-180.0, 180.0), position_mm(-2000.0, 2000.0);
  const Eigen::Vector3d at(position_mm(random), position_mm(random), position_mm(random));
  return FromPositionAndRollPitchYaw(at, {angle_deg(random), angle_deg(random), angle_deg(random)});
}

TEST(RigidTransform, ChainsCancelAndInversesUndo) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const RigidTransform world_from_part = RandomTransform(random), cam_from_world = RandomTransform(random);
    const Eigen::Vector3d x_in_part(12.0, -345.0, 678.0);
    const RigidTransform cam_from_part = cam_from_world * world_from_part;
    EXPECT_LT((cam_from_part * x_in_part - cam_from_world * (world_from_part * x_in_part)).norm(),
              kRoundingMm);
    EXPECT_LT((cam_from_part.Inverse() * (cam_from_part * x_in_part) - x_in_part).norm(), kRoundingMm);
    const RigidTransform identity = cam_from_part * cam_from_part.Inverse();
    EXPECT_LT((identity.rotation - Eigen::Matrix3d::Identity()).norm(), kRounding);
    EXPECT_LT(identity.translation_mm.norm(), kRoundingMm);
    EXPECT_TRUE(IsRotation(cam_from_part.rotation, kRounding));
  }
}

TEST(RigidTransform, RollPitchYawTurnsAboutFixedAxesInThatOrder) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const auto turned = [&](const Eigen::Vector3d& rpy_deg, const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return FromPositionAndRollPitchYaw(none, rpy_deg) * x;
  };
  using V = Eigen::Vector3d;
  EXPECT_TRUE(turned({90, 0, 0}, V::UnitY()).isApprox(V::UnitZ(), kRounding));
  EXPECT_TRUE(turned({0, 90, 0}, V::UnitZ()).isApprox(V::UnitX(), kRounding));
  EXPECT_TRUE(turned({0, 0, 90}, V::UnitX()).isApprox(V::UnitY(), kRounding));
  // Roll y to z, then yaw leaves z; the other order would give -x.
  EXPECT_TRUE(turned({90, 0, 90}, V::UnitY()).isApprox(V::UnitZ(), kRounding));
  // Roll takes y to z, pitch z to x, yaw x to y.
  EXPECT_TRUE(turned({90, 90, 90}, V::UnitY()).isApprox(V::UnitY(), kRounding));
}

TEST(RigidTransform, PositionIsWhereTheOriginGoes) {
  const Eigen::Vector3d position_mm(1.0, 2.0, 3.0);
  EXPECT_EQ(FromPositionAndRollPitchYaw(position_mm, {10, 20, 30}) * Eigen::Vector3d::Zero(), position_mm);
}

TEST(CamFromWorldLookingAt, TargetIsAheadAndUpIsUpInThePicture) {
  const Eigen::Vector3d eye(1000, -2000, 1500), target(100, 50, -20);
  const RigidTransform cam_from_world = CamFromWorldLookingAt(eye, target);
  EXPECT_TRUE(IsRotation(cam_from_world.rotation, kRounding));
  EXPECT_LT((cam_from_world * eye).norm(), kRoundingMm);
  const Eigen::Vector3d target_in_cam = cam_from_world * target;
  EXPECT_LT(target_in_cam.head<2>().norm(), kRoundingMm);
  EXPECT_NEAR(target_in_cam.z(), (target - eye).norm(), kRoundingMm);
  // y points down in the picture, x keeps level.
  EXPECT_LT((cam_from_world * (target + Eigen::Vector3d::UnitZ())).y(), 0.0);
  EXPECT_NEAR((cam_from_world.rotation * Eigen::Vector3d::UnitZ()).x(), 0.0, kRounding);
}

TEST(CamFromWorldLookingAt, StraightDownStillHasARotation) {
  for (const double side : {1.0, -1.0}) {
    const RigidTransform cam_from_world = CamFromWorldLookingAt({0, 0, side * 500}, {0, 0, 0});
    EXPECT_TRUE(IsRotation(cam_from_world.rotation, kRounding));
    EXPECT_NEAR((cam_from_world * Eigen::Vector3d::Zero()).z(), 500.0, kRoundingMm);
  }
  const RigidTransform along_y = CamFromWorldLookingAt({0, -5, 0}, {0, 5, 0}, Eigen::Vector3d::UnitY());
  EXPECT_TRUE(IsRotation(along_y.rotation, kRounding));
}

TEST(CamFromWorldLookingAt, EyeAndTargetMustDiffer) {
  EXPECT_THROW((void)CamFromWorldLookingAt({1, 2, 3}, {1, 2, 3}), PreconditionError);
}

TEST(IsRotation, RefusesMirrorsScalesAndNaN) {
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  EXPECT_TRUE(IsRotation(identity));
  EXPECT_FALSE(IsRotation(-identity));
  EXPECT_FALSE(IsRotation(1.001 * identity));
  EXPECT_FALSE(IsRotation(Eigen::Matrix3d::Zero()));
  Eigen::Matrix3d with_nan = identity;
  with_nan(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(IsRotation(with_nan));
}

}  // namespace
}  // namespace elbowroom::core
