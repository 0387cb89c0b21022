#include "core/rigid_transform.h"

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/units.h"

namespace elbowroom::core {

RigidTransform FromPositionAndRollPitchYaw(const Eigen::Vector3d& position_mm,
                                           const Eigen::Vector3d& rotation_rpy_deg) {
  using Eigen::AngleAxisd;
  const Eigen::Matrix3d rotation =
      (AngleAxisd(RadiansFromDegrees(rotation_rpy_deg.z()), Eigen::Vector3d::UnitZ()) *
       AngleAxisd(RadiansFromDegrees(rotation_rpy_deg.y()), Eigen::Vector3d::UnitY()) *
       AngleAxisd(RadiansFromDegrees(rotation_rpy_deg.x()), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return {rotation, position_mm};
}

RigidTransform CamFromWorldLookingAt(const Eigen::Vector3d& eye_in_world,
                                     const Eigen::Vector3d& target_in_world,
                                     const Eigen::Vector3d& up_in_world) {
  const Eigen::Vector3d direction = target_in_world - eye_in_world;
  Require(direction.norm() > 0.0, "the camera and its target are different points");
  const Eigen::Vector3d forward = direction.normalized();
  Eigen::Vector3d right = forward.cross(up_in_world);
  if (right.norm() < 1e-9) right = forward.cross(Eigen::Vector3d::UnitY());
  if (right.norm() < 1e-9) right = forward.cross(Eigen::Vector3d::UnitX());
  right.normalize();
  const Eigen::Vector3d down = forward.cross(right);
  Eigen::Matrix3d rotation;
  rotation.row(0) = right.transpose();
  rotation.row(1) = down.transpose();
  rotation.row(2) = forward.transpose();
  return {rotation, -(rotation * eye_in_world)};
}

bool IsRotation(const Eigen::Matrix3d& matrix, double tolerance) {
  const Eigen::Matrix3d residual = matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  // Written so that a NaN entry fails.
  return residual.cwiseAbs().maxCoeff() <= tolerance && matrix.allFinite() && matrix.determinant() > 0.0;
}

}  // namespace elbowroom::core
