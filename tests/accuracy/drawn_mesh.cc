#include "tests/accuracy/drawn_mesh.h"

#include <algorithm>
#include <cmath>

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A vertex on its pixel, with 1/z, which is linear over the picture of a plane.
struct Drawn {
  Vector2d pixel;
  double inverse_depth = 0.0;
};

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

void DrawTriangle(const Drawn& a, const Drawn& b, const Drawn& c, recon::DepthMap* picture) {
  const double area = Cross(b.pixel - a.pixel, c.pixel - a.pixel);
  if (area == 0.0) return;
  const Vector2d low = a.pixel.cwiseMin(b.pixel).cwiseMin(c.pixel),
                 high = a.pixel.cwiseMax(b.pixel).cwiseMax(c.pixel);
  const int x0 = std::max(0, static_cast<int>(std::ceil(low.x()))),
            y0 = std::max(0, static_cast<int>(std::ceil(low.y())));
  const int x1 = std::min(picture->width_px - 1, static_cast<int>(std::floor(high.x())));
  const int y1 = std::min(picture->height_px - 1, static_cast<int>(std::floor(high.y())));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Vector2d p(x, y);
      const double u = Cross(c.pixel - b.pixel, p - b.pixel) / area,
                   v = Cross(a.pixel - c.pixel, p - c.pixel) / area;
      const double w = 1.0 - u - v;
      if (u < 0.0 || v < 0.0 || w < 0.0) continue;
      const double depth = 1.0 / (u * a.inverse_depth + v * b.inverse_depth + w * c.inverse_depth);
      float& pixel =
          picture->depth_mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture->width_px) +
                            static_cast<std::size_t>(x)];
      if (pixel == 0.0F) ++picture->hit_pixels;
      if (pixel == 0.0F || depth < pixel) pixel = static_cast<float>(depth);
    }
  }
}

}  // namespace

recon::DepthMap DrawMesh(const core::TriangleMesh& mesh_in_world, const core::CameraModel& view) {
  recon::DepthMap picture{view.width_px(), view.height_px(), {}, 0};
  picture.depth_mm.assign(
      static_cast<std::size_t>(view.width_px()) * static_cast<std::size_t>(view.height_px()), 0.0F);
  const Eigen::Matrix3d& k = view.calibration().camera_matrix;
  std::vector<Drawn> drawn;
  drawn.reserve(mesh_in_world.vertices_mm.size());
  for (const Vector3d& vertex : mesh_in_world.vertices_mm) {
    const Vector3d in_cam = view.cam_from_world() * vertex;
    drawn.push_back({(k * in_cam).hnormalized(), in_cam.z() > 0.0 ? 1.0 / in_cam.z() : 0.0});
  }
  for (const auto& triangle : mesh_in_world.triangles) {
    const Drawn &a = drawn[static_cast<std::size_t>(triangle[0])],
                &b = drawn[static_cast<std::size_t>(triangle[1])],
                &c = drawn[static_cast<std::size_t>(triangle[2])];
    if (a.inverse_depth > 0.0 && b.inverse_depth > 0.0 && c.inverse_depth > 0.0)
      DrawTriangle(a, b, c, &picture);
  }
  return picture;
}

}  // namespace elbowroom::accuracy
