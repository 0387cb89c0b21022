#include "app/control/placing/snap.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elbowroom::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The world's axis that is most across the direction, made exactly across it.
Vector3d AcrossOf(const Vector3d& direction) {
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  const Vector3d axis = Vector3d::Unit(least);
  return (axis - axis.dot(direction) * direction).normalized();
}

// The smallest rotation that takes one direction to the other (both of unit length).
Matrix3d TurnFromTo(const Vector3d& from, const Vector3d& to) {
  const Vector3d axis = from.cross(to);
  const double sine = axis.norm(), cosine = from.dot(to);
  constexpr double kOpposite = 1e-12;
  if (sine > kOpposite) return Eigen::AngleAxisd(std::atan2(sine, cosine), axis / sine).toRotationMatrix();
  if (cosine > 0.0) return Matrix3d::Identity();
  const Vector3d across = AcrossOf(from);
  return 2.0 * across * across.transpose() - Matrix3d::Identity();  // half a turn about it
}

// Turned about a point that stays, then shifted.
core::RigidTransform Moved(const core::RigidTransform& world_from_part, const Matrix3d& turn,
                           const Vector3d& about, const Vector3d& shift_mm) {
  return core::RigidTransform{turn, about - turn * about + shift_mm} * world_from_part;
}

}  // namespace

core::RigidTransform FaceToFace(const core::RigidTransform& world_from_part, const FacePlace& moving,
                                const FacePlace& fixed) {
  const Vector3d& normal = fixed.normal_in_world;
  return Moved(world_from_part, TurnFromTo(moving.normal_in_world, -normal), moving.point_in_world,
               normal.dot(fixed.point_in_world - moving.point_in_world) * normal);
}

core::RigidTransform AxisToAxis(const core::RigidTransform& world_from_part, const AxisLine& moving,
                                const AxisLine& fixed) {
  const Vector3d along = moving.direction_in_world.dot(fixed.direction_in_world) < 0.0
                             ? Vector3d(-fixed.direction_in_world)
                             : fixed.direction_in_world;
  const Vector3d between = fixed.point_in_world - moving.point_in_world;
  return Moved(world_from_part, TurnFromTo(moving.direction_in_world, along), moving.point_in_world,
               between - along.dot(between) * along);
}

}  // namespace elbowroom::control
