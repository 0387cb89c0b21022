#include "recon/error_budget/swept_margins.h"

#include <cmath>
#include <utility>

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {

using Eigen::Vector3d;

struct SweptMargins::Corners {
  Vector3d a, b, c;  // world
};

SweptMargins::SweptMargins(const VisualHull& hull, std::vector<double> margins_px)
    : hull_(hull), margins_px_(std::move(margins_px)), cells_(margins_px_.size()) {}

bool SweptMargins::Exclude(const core::TriangleTree& part, const core::RigidTransform& world_from_part,
                           double distance_mm, double finest_mm) {
  if (part.nodes().empty()) return true;
  distance_mm_ = distance_mm;
  finest_mm_ = finest_mm;
  return ExcludeNode(part, world_from_part, 0);
}

bool SweptMargins::ExcludeNode(const core::TriangleTree& part, const core::RigidTransform& world_from_part,
                               std::uint32_t at) {
  const core::TriangleTree::Node& node = part.nodes()[at];
  if (Exclude({world_from_part * node.ball.center, node.ball.radius_mm + distance_mm_})) return true;
  if (node.left != 0)
    return ExcludeNode(part, world_from_part, node.left) && ExcludeNode(part, world_from_part, node.left + 1);
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    const auto& triangle = part.mesh().triangles[part.order()[i]];
    const auto corner = [&](std::size_t k) {
      return world_from_part * part.mesh().vertices_mm[static_cast<std::size_t>(triangle[k])];
    };
    if (!Exclude(Corners{corner(0), corner(1), corner(2)})) return false;
  }
  return true;
}

bool SweptMargins::Exclude(const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  core::Ball ball = core::BallOf(a, b, c);
  const bool is_finest = ball.radius_mm <= finest_mm_;
  ball.radius_mm += distance_mm_;
  if (Exclude(ball)) return true;
  if (is_finest) return false;
  // Turned so that the longest side is the first, which is halved.
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  const Corners turned = bc >= ab && bc >= ca ? Corners{b, c, a} : ca >= ab ? Corners{c, a, b} : triangle;
  const Vector3d middle = 0.5 * (turned.a + turned.b);
  return Exclude(Corners{turned.a, middle, turned.c}) && Exclude(Corners{middle, turned.b, turned.c});
}

bool SweptMargins::Exclude(const core::Ball& ball) {
  for (std::size_t k = 0; k < margins_px_.size(); ++k) {
    const core::CameraIndex camera = (likely_ + k) % margins_px_.size();
    if (!std::isfinite(margins_px_[camera])) continue;
    const Vector3d x_in_cam = hull_.rig().cameras[camera].cam_from_world() * ball.center;
    const double z = x_in_cam.z(), r = ball.radius_mm;
    if (!(z > r)) continue;
    const Silhouette& silhouette = *hull_.silhouettes()[camera];
    const double focal_px = silhouette.plane().focal_px();
    // Every point of the ball projects within this of its centre (docs/algorithms.md).
    const double reach_px = focal_px * r * x_in_cam.norm() / (z * (z - r)) + margins_px_[camera];
    const Eigen::Vector2d position = x_in_cam.head<2>() * (focal_px / z);
    const ContourMap& labels = silhouette.labels();
    const PlaneLabel label = labels.LabelAt(position, reach_px);
    if (label.is_object) continue;
    if (label.distance_px < reach_px) {
      // The map's distance may be too short.
      if (labels.EdgeWithinPx(position) < reach_px) continue;
      std::optional<VertexCells>& cells = cells_[camera];
      if (!cells) cells.emplace(labels.contour());
      if (cells->NearestPx(position) - kVertexSpacingPx < reach_px) continue;
    }
    likely_ = camera;
    return true;
  }
  return false;
}

}  // namespace elbowroom::recon
