#include "recon/hull/camera_query.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "recon/contours/contour_kernel.h"

namespace elbowroom::recon {
namespace {

// Radii shrink by this much for the rounding of their own computation ...
constexpr double kRadiusSlack = 1e-9;
// ... and by this share of the coordinates' size for theirs: of the centre, of the ball's points, on the way
// into the camera.
constexpr double kBallRounding = 4e-15;
// More than a label's distance loses to rounding.
constexpr double kPositionSlackPx = 1e-6;

// Largest r such that every point within r of x projects, in the normalised plane, within `reach` of x's own
// projection: r |x| / (Z (Z - r)) <= reach, solved for r; always below Z.
double RadiusOfReach(const Eigen::Vector3d& x_in_cam, double reach) {
  if (std::isinf(reach)) return x_in_cam.z() * (1.0 - kRadiusSlack);
  const double z = x_in_cam.z();
  return reach * z * z / (x_in_cam.norm() + reach * z) * (1.0 - kRadiusSlack);
}

// The reach that a radius needs; infinite for a ball that reaches the camera's plane.
double ReachOfRadius(const Eigen::Vector3d& x_in_cam, double radius_mm) {
  const double z = x_in_cam.z();
  if (!(radius_mm < z)) return std::numeric_limits<double>::infinity();
  return radius_mm * x_in_cam.norm() / (z * (z - radius_mm));
}

// Distance from x to the cone about the z axis that holds all edges: negative inside it.
double DistanceToCone(const Eigen::Vector3d& x_in_cam, double slope) {
  const double length = std::sqrt(1.0 + slope * slope);
  const double across = x_in_cam.head<2>().norm();
  const double to_surface = (across - slope * x_in_cam.z()) / length;
  const double along_surface = (across * slope + x_in_cam.z()) / length;
  return along_surface > 0.0 ? to_surface : x_in_cam.norm();
}

double DistanceToEdges(const Eigen::Vector3d& x_in_cam, double focal_px, const ContourMap& labels) {
  if (labels.bounds_px().isEmpty()) return std::numeric_limits<double>::infinity();
  return DistanceToCone(x_in_cam, labels.max_radius_px() / focal_px) * (1.0 - kRadiusSlack);
}

// Nothing behind the camera, or so far aside that the position isn't finite.
std::optional<Eigen::Vector2d> PositionOf(const Eigen::Vector3d& x_in_cam, double focal_px) {
  if (!(x_in_cam.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d position = x_in_cam.head<2>() * (focal_px / x_in_cam.z());
  if (!position.allFinite()) return std::nullopt;
  return position;
}

}  // namespace

BallLabel AskPlane(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                   const Eigen::Vector3d& x_in_world, double enough_mm) {
  const Eigen::Vector3d x_in_cam = camera.cam_from_world() * x_in_world;
  const double rounding_mm =
      kBallRounding * (x_in_world.lpNorm<1>() + camera.cam_from_world().translation_mm.lpNorm<1>());
  BallLabel answer{labels.exterior_is_object(), 0.0};
  if (const std::optional<Eigen::Vector2d> position = PositionOf(x_in_cam, focal_px)) {
    const double enough = ReachOfRadius(x_in_cam, enough_mm * (1.0 + 2.0 * kRadiusSlack) + 2.0 * rounding_mm);
    const PlaneLabel label =
        labels.LabelAt(*position, enough * focal_px * (1.0 + kRadiusSlack) + kPositionSlackPx);
    answer = {label.is_object, RadiusOfReach(x_in_cam, label.distance_px / focal_px)};
  }
  // For a ball that isn't in front of the camera, or reaches behind it: the exterior label also holds up to
  // the cone that holds all edges.
  if (answer.is_object == labels.exterior_is_object() && answer.radius_mm < enough_mm)
    answer.radius_mm = std::max(answer.radius_mm, DistanceToEdges(x_in_cam, focal_px, labels));
  answer.radius_mm = std::max(answer.radius_mm - rounding_mm, 0.0);
  return answer;
}

double ChangesWithinMm(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                       const Eigen::Vector3d& x_in_world) {
  const Eigen::Vector3d x_in_cam = camera.cam_from_world() * x_in_world;
  const std::optional<Eigen::Vector2d> position = PositionOf(x_in_cam, focal_px);
  if (!position) return std::numeric_limits<double>::infinity();
  return x_in_cam.z() * labels.EdgeWithinPx(*position) / focal_px;
}

std::optional<bool> LabelOfShape(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                                 const WorldShape& shape) {
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  const Eigen::Vector3d origin = cam_from_world * shape.origin;
  const Eigen::Matrix3d edges = cam_from_world.rotation * shape.edges;
  const double least_z = origin.z() - edges.row(2).lpNorm<1>();
  if (!(least_z > 0.0)) return std::nullopt;
  if (labels.bounds_px().isEmpty()) return labels.exterior_is_object();
  GridView view;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double scale = k < 2 ? focal_px : 1.0;
    view.origin[static_cast<std::size_t>(k)] = scale * origin[k];
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      view.steps[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)] = scale * edges(k, axis);
  }
  // As for a ball: how far rounding moves a point in the picture.
  const double rounding_mm = kBallRounding * (shape.origin.lpNorm<1>() + shape.edges.lpNorm<1>() +
                                              cam_from_world.translation_mm.lpNorm<1>());
  const double farthest_mm = origin.norm() + edges.norm();
  const double slack_px = kPositionSlackPx + focal_px * rounding_mm * farthest_mm / (least_z * least_z);
  const ConvexCorners& corners =
      shape.kind == WorldShape::Kind::kBox ? ConvexCorners::OfBox() : ConvexCorners::OfTriangle();
  if (!IsClearOfEdges(view, corners, labels.CellsView(), slack_px)) return std::nullopt;
  return labels.IsObject(origin.head<2>() * (focal_px / origin.z()));
}

bool IsObjectTo(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                const Eigen::Vector3d& x_in_world) {
  const std::optional<Eigen::Vector2d> position = PositionOf(camera.cam_from_world() * x_in_world, focal_px);
  return position ? labels.IsObject(*position) : labels.exterior_is_object();
}

bool LabelInCam(const ContourMap& labels, double focal_px, const Eigen::Vector3d& x_in_cam) {
  const std::optional<Eigen::Vector2d> position = PositionOf(x_in_cam, focal_px);
  return position ? IsObjectByParity(labels.contour(), labels.exterior_is_object(), *position)
                  : labels.exterior_is_object();
}

}  // namespace elbowroom::recon
