// From a drag of the pointer to a move along a line or a turn about one.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "app/control/picking/pick.h"
#include "core/rigid_transform.h"

namespace elbowroom::control {

// A line in world; the direction is of unit length.
struct AxisLine {
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_in_world = Eigen::Vector3d::UnitZ();
};

// Where along the axis, from its point, the ray comes nearest to it, mm. Nothing where the eye looks along
// the axis (within a degree): then a pixel is too much.
[[nodiscard]] std::optional<double> NearestAlong(const AxisLine& axis, const PickRay& ray);

// The direction about the axis in which the ray meets the plane through its point across it: radians from any
// fixed direction, so that only differences mean something. Nothing where the ray doesn't meet the plane, or
// lies in it (within a degree), or meets it in the point.
[[nodiscard]] std::optional<double> DirectionAbout(const AxisLine& axis, const PickRay& ray);

// To the nearest multiple of the step; the value itself where the step is 0.
[[nodiscard]] double Snapped(double value, double step);

// The pose turned about the axis: counter-clockwise seen against its direction.
[[nodiscard]] core::RigidTransform TurnedAbout(const AxisLine& axis, double angle_rad,
                                               const core::RigidTransform& world_from_part);

}  // namespace elbowroom::control
