#include "app/control/placing/drag.h"

#include <Eigen/Geometry>
#include <cmath>

namespace elbowroom::control {
namespace {

constexpr double kLeastSine = 0.0175;  // of a degree

}  // namespace

std::optional<double> NearestAlong(const AxisLine& axis, const PickRay& ray) {
  // s a + w = t r + e with both residuals across e: s (1 - c^2) = c (r . w) - a . w, where w = p - o.
  const double cosine = axis.direction_in_world.dot(ray.direction_in_world);
  const double square_of_sine = 1.0 - cosine * cosine;
  if (square_of_sine < kLeastSine * kLeastSine) return std::nullopt;
  const Eigen::Vector3d from_eye = axis.point_in_world - ray.origin_in_world;
  return (cosine * ray.direction_in_world.dot(from_eye) - axis.direction_in_world.dot(from_eye)) /
         square_of_sine;
}

std::optional<double> DirectionAbout(const AxisLine& axis, const PickRay& ray) {
  const double across = axis.direction_in_world.dot(ray.direction_in_world);
  if (std::abs(across) < kLeastSine) return std::nullopt;
  const double along_mm = axis.direction_in_world.dot(axis.point_in_world - ray.origin_in_world) / across;
  if (along_mm <= 0.0) return std::nullopt;
  const Eigen::Vector3d met = ray.origin_in_world + along_mm * ray.direction_in_world - axis.point_in_world;
  const Eigen::Vector3d first = axis.direction_in_world.unitOrthogonal();
  const Eigen::Vector3d second = axis.direction_in_world.cross(first);
  const double x = met.dot(first), y = met.dot(second);
  if (x == 0.0 && y == 0.0) return std::nullopt;
  return std::atan2(y, x);
}

double Snapped(double value, double step) { return step > 0.0 ? std::round(value / step) * step : value; }

core::RigidTransform TurnedAbout(const AxisLine& axis, double angle_rad,
                                 const core::RigidTransform& world_from_part) {
  core::RigidTransform turn;
  turn.rotation = Eigen::AngleAxisd(angle_rad, axis.direction_in_world).toRotationMatrix();
  turn.translation_mm = axis.point_in_world - turn.rotation * axis.point_in_world;
  return turn * world_from_part;
}

}  // namespace elbowroom::control
