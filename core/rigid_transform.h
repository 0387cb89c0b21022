// Rotation and translation between two frames; named b_from_a, so that chains cancel.
#pragma once

#include <Eigen/Core>

namespace elbowroom::core {

// x_in_b = rotation * x_in_a + translation_mm.
struct RigidTransform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& x_in_a) const {
    return rotation * x_in_a + translation_mm;
  }
  // c_from_b * b_from_a = c_from_a.
  [[nodiscard]] RigidTransform operator*(const RigidTransform& b_from_a) const {
    return {rotation * b_from_a.rotation, rotation * b_from_a.translation_mm + translation_mm};
  }
  [[nodiscard]] RigidTransform Inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation_mm)};
  }
  [[nodiscard]] bool operator==(const RigidTransform& other) const {
    return rotation == other.rotation && translation_mm == other.translation_mm;
  }
};

// Rotation about the fixed x (roll), then y (pitch), then z (yaw) axis: R = Rz * Ry * Rx; angles in degrees.
[[nodiscard]] RigidTransform FromPositionAndRollPitchYaw(const Eigen::Vector3d& position_mm,
                                                         const Eigen::Vector3d& rotation_rpy_deg);

// Camera at `eye` with its z axis through `target` and its y axis (image down) away from `up`; x right,
// y down, z forward. If the view direction is parallel to `up`, the world's y axis, or else its x axis, takes
// its place. Throws: PreconditionError if `eye` is `target`.
[[nodiscard]] RigidTransform CamFromWorldLookingAt(
    const Eigen::Vector3d& eye_in_world, const Eigen::Vector3d& target_in_world,
    const Eigen::Vector3d& up_in_world = Eigen::Vector3d::UnitZ());

// True if `matrix` is orthonormal with determinant +1, each entry of R R^T - I within `tolerance`.
[[nodiscard]] bool IsRotation(const Eigen::Matrix3d& matrix, double tolerance = 1e-6);

}  // namespace elbowroom::core
