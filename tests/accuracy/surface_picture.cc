#include "tests/accuracy/surface_picture.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

// Neighbours farther apart in depth than this belong to different sheets of the surface.
constexpr double kJumpMm = 12.0;

double DistanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + share * along - p).norm();
}

}  // namespace

double DistanceToTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const auto is_left = [&](const Vector3d& from, const Vector3d& to) {
    return (to - from).cross(p - from).dot(normal) >= 0.0;
  };
  if (area2 > 0.0 && is_left(a, b) && is_left(b, c) && is_left(c, a))
    return std::abs((p - a).dot(normal)) / std::sqrt(area2);
  return std::min({DistanceToSegment(p, a, b), DistanceToSegment(p, b, c), DistanceToSegment(p, c, a)});
}

recon::Ray RayThrough(const core::CameraModel& view, int x, int y) {
  const auto normalised = view.NormalisedFromPixel({x, y});
  core::Require(normalised.has_value(), "the lens has a ray for every pixel");
  return {view.center_in_world(),
          (view.cam_from_world().rotation.transpose() * normalised->homogeneous()).normalized()};
}

recon::DepthMap PictureOf(const core::CameraModel& view, const FirstSurfaceOf& first_surface, int stride) {
  recon::DepthMap picture{view.width_px(), view.height_px(), {}, 0};
  picture.depth_mm.assign(
      static_cast<std::size_t>(view.width_px()) * static_cast<std::size_t>(view.height_px()), 0.0F);
  const Vector3d forward = view.cam_from_world().rotation.row(2).transpose();
  std::atomic<std::int64_t> hits = 0;
  tbb::parallel_for(0, (view.height_px() + stride - 1) / stride, [&](int row) {
    const int y = row * stride;
    for (int x = 0; x < view.width_px(); x += stride) {
      const recon::Ray ray = RayThrough(view, x, y);
      const std::optional<double> distance_mm = first_surface(ray);
      if (!distance_mm) continue;
      ++hits;
      picture.depth_mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width_px()) +
                       static_cast<std::size_t>(x)] =
          static_cast<float>(*distance_mm * ray.direction_in_world.dot(forward));
    }
  });
  picture.hit_pixels = hits;
  return picture;
}

SurfacePicture::SurfacePicture(core::CameraModel view, recon::DepthMap depth)
    : view_(std::move(view)), depth_(std::move(depth)) {
  core::Require(depth_.width_px == view_.width_px() && depth_.height_px == view_.height_px(),
                "a depth map has its view's size");
}

double SurfacePicture::DepthAt(int x, int y) const {
  return depth_.depth_mm[static_cast<std::size_t>(y) * static_cast<std::size_t>(depth_.width_px) +
                         static_cast<std::size_t>(x)];
}

Vector3d SurfacePicture::PointAt(int x, int y, double depth_mm) const {
  const Eigen::Matrix3d& k = view_.calibration().camera_matrix;
  const Vector3d x_in_cam((x - k(0, 2)) / k(0, 0), (y - k(1, 2)) / k(1, 1), 1.0);
  return view_.center_in_world() + depth_mm * (view_.cam_from_world().rotation.transpose() * x_in_cam);
}

// The point of pixel (x, y), and the two triangles of the square of pixels of which it is the first.
void SurfacePicture::TakeNearer(const Vector3d& point_in_world, int x, int y, double* nearest_mm) const {
  if (x < 0 || y < 0 || x >= depth_.width_px || y >= depth_.height_px) return;
  if (const double depth_mm = DepthAt(x, y); depth_mm > 0.0) {
    *nearest_mm = std::min(*nearest_mm, (PointAt(x, y, depth_mm) - point_in_world).norm());
  }
  if (x + 1 >= depth_.width_px || y + 1 >= depth_.height_px) return;
  const std::array<std::array<int, 2>, 4> corners = {{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
  const auto take = [&](std::size_t i, std::size_t j, std::size_t k) {
    std::array<Vector3d, 3> corner;
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (std::size_t n = 0; const std::size_t index : {i, j, k}) {
      const double depth_mm = DepthAt(corners[index][0], corners[index][1]);
      low = std::min(low, depth_mm);
      high = std::max(high, depth_mm);
      corner[n++] = PointAt(corners[index][0], corners[index][1], depth_mm);
    }
    if (low <= 0.0 || high - low > kJumpMm) return;
    *nearest_mm = std::min(*nearest_mm, DistanceToTriangle(point_in_world, corner[0], corner[1], corner[2]));
  };
  take(0, 1, 2);
  take(0, 2, 3);
}

std::optional<double> SurfacePicture::DistanceMm(const Vector3d& point_in_world, int x, int y) const {
  const Eigen::Matrix3d& k = view_.calibration().camera_matrix;
  double nearest_mm = std::numeric_limits<double>::infinity();
  // Ring by ring; a triangle `ring` pixels off stands no nearer than half of what those span at half the
  // depth.
  for (int ring = 0; ring <= kReachPx; ++ring) {
    const double depth_mm = (view_.cam_from_world() * point_in_world).z();
    if (nearest_mm < 0.5 * (ring - 1) * depth_mm / std::max(k(0, 0), k(1, 1))) break;
    for (int dy = -ring; dy <= ring; ++dy) {
      const int step = std::abs(dy) == ring ? 1 : std::max(2 * ring, 1);
      for (int dx = -ring; dx <= ring; dx += step) TakeNearer(point_in_world, x + dx, y + dy, &nearest_mm);
    }
  }
  if (!std::isfinite(nearest_mm)) return std::nullopt;
  return nearest_mm;
}

}  // namespace elbowroom::accuracy
