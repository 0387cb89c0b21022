#include "recon/exact_view/hull_normals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "recon/contours/silhouette.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// The normals at all edges of a camera's contour, and under `abstain` those of its outline after them.
std::vector<Vector3f> EdgeNormals(const VisualHull& hull, std::size_t camera) {
  const Eigen::Matrix3d world_from_cam = hull.rig().cameras[camera].cam_from_world().rotation.transpose();
  const UndistortedPlane& plane = hull.silhouettes()[camera]->plane();
  std::vector<Vector3f> normals;
  const auto add = [&](const Contour& contour) {
    for (std::uint32_t i = 0; i < contour.edges.size(); ++i)
      normals.push_back((world_from_cam * OutwardNormalInCam(contour, i, plane.focal_px())).cast<float>());
  };
  add(hull.silhouettes()[camera]->labels().contour());
  if (ExteriorIsObject(hull.rig())) add(plane.outline().contour());
  return normals;
}

// The normal of the face of the workspace, or of the half-space's plane, that a point of the surface is on.
Vector3f FaceNormal(const Eigen::AlignedBox3d& box, const std::vector<HalfSpace>& half_spaces,
                    const Vector3d& x_in_world) {
  Eigen::Index low = 0, high = 0;
  const double below = (x_in_world - box.min()).cwiseAbs().minCoeff(&low);
  const double above = (box.max() - x_in_world).cwiseAbs().minCoeff(&high);
  double nearest = std::min(below, above);
  Vector3f normal = below < above ? Vector3f(-Vector3f::Unit(low)) : Vector3f(Vector3f::Unit(high));
  for (const HalfSpace& half_space : half_spaces) {
    const double off = std::abs(half_space.BeyondMm(x_in_world));
    if (off >= nearest) continue;
    nearest = off;
    normal = half_space.outward.cast<float>();
  }
  return normal;
}

}  // namespace

HullNormals::HullNormals(const VisualHull& hull, const ViewRays& rays)
    : hull_(hull),
      rays_(rays),
      world_from_view_(rays.view_from_world().Inverse()),
      edge_normals_(hull.silhouettes().size()) {
  tbb::parallel_for(std::size_t{0}, edge_normals_.size(),
                    [&](std::size_t i) { edge_normals_[i] = EdgeNormals(hull, i); });
}

Vector3f HullNormals::Of(const HullSurface& surface, int x, int y, float depth_mm) const {
  if (const auto camera = surface.camera()) return edge_normals_[*camera][surface.edge()];
  const Eigen::Vector2d uv = rays_.At(x, y);
  const double z_mm = depth_mm;
  const bool is_perspective = rays_.projection() == Projection::kPerspective;
  const Vector3d x_in_view =
      is_perspective ? Vector3d(uv.x() * z_mm, uv.y() * z_mm, z_mm) : Vector3d(uv.x(), uv.y(), z_mm);
  return FaceNormal(hull_.rig().workspace_mm, rays_.half_spaces(), world_from_view_ * x_in_view);
}

PictureBuffer<Vector3f> NormalsOf(const VisualHull& hull, const ViewRays& rays, const HullView& view) {
  if (view.hit_pixels == 0) {
    return {view.surface.size(), Vector3f(Vector3f::Zero()), LeavesUnset<Vector3f>()};
  }
  PictureBuffer<Vector3f> normals(view.surface.size());
  const HullNormals hull_normals(hull, rays);
  tbb::parallel_for(0, view.height_px, [&](int y) {
    for (int x = 0; x < view.width_px; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width_px) + static_cast<std::size_t>(x);
      const HullSurface& surface = view.surface[pixel];
      normals[pixel] = surface.is_hit() ? hull_normals.Of(surface, x, y, view.depth_mm[pixel])
                                        : Vector3f(Vector3f::Zero());
    }
  });
  return normals;
}

}  // namespace elbowroom::recon
