#include "recon/hull/hull_depth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/infinity.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/camera_query.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

using core::kInfinity;
// Depths are short by this share of themselves, and of the coordinates' size, for rounding.
constexpr double kDepthSlack = 1e-9;
constexpr double kDepthRounding = 1e-14;

struct Nearest {
  double square = kInfinity;
  Vector3d point = Vector3d::Zero();  // in cam

  void Offer(double distance_squared, const Vector3d& x) {
    if (distance_squared >= square) return;
    square = distance_squared;
    point = x;
  }
};

// The nearest point of the surfaces at which a contour's label changes. An edge's surface is a sector of a
// plane: from the camera's centre on, between the sight rays of the edge's ends. Its nearest point is the
// foot of the perpendicular, if that is in the sector, or else on one of the two rays.
Nearest NearestSurface(const Contour& contour, double focal_px, const Vector3d& x_in_cam) {
  Nearest nearest;
  const auto direction = [&](std::uint32_t vertex) {
    return Vector3d(contour.vertices[vertex].x(), contour.vertices[vertex].y(), focal_px);
  };
  for (const Eigen::Vector2d& vertex : contour.vertices) {
    const Vector3d ray(vertex.x(), vertex.y(), focal_px);
    const Vector3d foot = std::max(ray.dot(x_in_cam), 0.0) / ray.squaredNorm() * ray;
    nearest.Offer((x_in_cam - foot).squaredNorm(), foot);
  }
  for (const ContourEdge& edge : contour.edges) {
    const Vector3d a = direction(edge.from), b = direction(edge.to), normal = a.cross(b);
    const double height = normal.dot(x_in_cam), square = normal.squaredNorm();
    if (!(height * height < nearest.square * square)) continue;
    // Whether the foot is between the two rays. The test may take x itself: the foot is x less a multiple of
    // the normal, which changes neither product.
    if (a.cross(x_in_cam).dot(normal) < 0.0 || x_in_cam.cross(b).dot(normal) < 0.0) continue;
    nearest.Offer(height * height / square, x_in_cam - height / square * normal);
  }
  return nearest;
}

HullDepth DepthIn(const core::CameraModel& camera, core::CameraIndex index, const Nearest& nearest,
                  const Vector3d& x_in_world) {
  const double rounding_mm =
      kDepthRounding * (x_in_world.lpNorm<1>() + camera.cam_from_world().translation_mm.lpNorm<1>());
  const double depth_mm = std::sqrt(nearest.square) * (1.0 - kDepthSlack) - rounding_mm;
  return {std::max(depth_mm, 0.0), camera.cam_from_world().Inverse() * nearest.point, index};
}

HullDepth ToFaces(const Eigen::AlignedBox3d& box, const Vector3d& x_in_world) {
  HullDepth depth{kInfinity, x_in_world, {}};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double face_mm : {box.min()[axis], box.max()[axis]}) {
      const double distance_mm = std::abs(face_mm - x_in_world[axis]) * (1.0 - kDepthSlack);
      if (distance_mm >= depth.depth_mm) continue;
      depth = {distance_mm, x_in_world, {}};
      depth.nearest_in_world[axis] = face_mm;
    }
  }
  return depth;
}

}  // namespace

std::optional<HullDepth> DepthAt(const VisualHull& hull, const Vector3d& x_in_world) {
  if (!hull.Contains(x_in_world)) return std::nullopt;
  HullDepth depth = ToFaces(hull.rig().workspace_mm, x_in_world);
  HullDepth sight{-1.0, x_in_world, {}};
  for (std::size_t i = 0; i < hull.silhouettes().size(); ++i) {
    const core::CameraModel& camera = hull.rig().cameras[i];
    const UndistortedPlane& plane = hull.silhouettes()[i]->plane();
    const Vector3d x_in_cam = camera.cam_from_world() * x_in_world;
    const auto depth_in = [&](const Contour& contour) {
      return DepthIn(camera, i, NearestSurface(contour, plane.focal_px(), x_in_cam), x_in_world);
    };
    const Contour& contour = hull.silhouettes()[i]->labels().contour();
    if (!contour.edges.empty()) {
      const HullDepth here = depth_in(contour);
      if (here.depth_mm < depth.depth_mm) depth = here;
    }
    if (!ExteriorIsObject(hull.rig()) || !IsObjectTo(camera, plane.focal_px(), plane.outline(), x_in_world))
      continue;
    const HullDepth seen = depth_in(plane.outline().contour());
    if (seen.depth_mm > sight.depth_mm) sight = seen;
  }
  return ExteriorIsObject(hull.rig()) && sight.depth_mm < depth.depth_mm ? sight : depth;
}

}  // namespace elbowroom::recon
