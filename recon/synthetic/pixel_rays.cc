#include "recon/synthetic/pixel_rays.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr int kTileSidePx = 16;
constexpr double kRoundingSlack = 1e-9;   // keeps the cone test on the safe side
constexpr double kRayTolerancePx = 1e-5;  // a tenth of what single precision leaves of a ray

Eigen::Vector2d RayThrough(const core::CameraModel& camera, const Eigen::Vector2d& pixel) {
  const auto normalised = camera.NormalisedFromPixel(pixel);
  if (normalised) return *normalised;
  throw core::Error(
      core::ErrorKind::kCamera,
      fmt::format("camera {}: its lens has no ray for pixel ({}, {}); use weaker distortion or a "
                  "smaller image",
                  camera.name(), pixel.x(), pixel.y()));
}

// A few chord steps from a guess a pixel away: far cheaper than inverting the lens anew. Nothing where they
// don't converge, as with strong lenses.
std::optional<Eigen::Vector2d> Refined(const core::CameraModel& camera, const Eigen::Vector2d& pixel,
                                       Eigen::Vector2d normalised) {
  constexpr int kSteps = 8;
  const Eigen::Matrix3d& k = camera.calibration().camera_matrix;
  for (int i = 0; i < kSteps; ++i) {
    if (!(normalised.norm() <= camera.max_radius())) return std::nullopt;
    const Eigen::Vector2d error_px = pixel - camera.PixelFromNormalised(normalised);
    if (error_px.norm() < kRayTolerancePx) return normalised;
    const double y = error_px.y() / k(1, 1);
    normalised += Eigen::Vector2d((error_px.x() - k(0, 1) * y) / k(0, 0), y);
  }
  return std::nullopt;
}

}  // namespace

PixelRays::PixelRays(const core::CameraModel& camera)
    : width_px_(camera.width_px()),
      height_px_(camera.height_px()),
      center_in_world_(camera.center_in_world()),
      world_from_cam_(camera.cam_from_world().rotation.transpose()) {
  normalised_.resize(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_));
  tbb::parallel_for(0, height_px_, [&](int y) {
    Eigen::Vector2d guess = RayThrough(camera, {0.0, y});
    Eigen::Vector2d step = Eigen::Vector2d::Zero();  // from pixel to pixel; added to `guess` for the next one
    for (int x = 0; x < width_px_; ++x) {
      const auto refined = Refined(camera, {x, y}, guess + step);
      const Eigen::Vector2d normalised = refined ? *refined : RayThrough(camera, {x, y});
      step = normalised - guess;
      guess = normalised;
      normalised_[Index(x, y)] = normalised.cast<float>();
    }
  });
  for (int y = 0; y < height_px_; y += kTileSidePx) {
    for (int x = 0; x < width_px_; x += kTileSidePx) tiles_.push_back(Tile(x, y));
  }
}

Ray PixelRays::At(int x, int y) const {
  const Eigen::Vector2d normalised = normalised_[Index(x, y)].cast<double>();
  return {center_in_world_, (world_from_cam_ * normalised.homogeneous()).normalized()};
}

Ray PixelRays::At(int x, int y, const Eigen::Vector2d& from_center_px) const {
  const auto at = [&](int u, int v) -> Eigen::Vector2d { return normalised_[Index(u, v)].cast<double>(); };
  const int x0 = std::max(x - 1, 0), x1 = std::min(x + 1, width_px_ - 1);
  const int y0 = std::max(y - 1, 0), y1 = std::min(y + 1, height_px_ - 1);
  Eigen::Vector2d normalised = at(x, y);
  if (x1 > x0) normalised += from_center_px.x() / (x1 - x0) * (at(x1, y) - at(x0, y));
  if (y1 > y0) normalised += from_center_px.y() / (y1 - y0) * (at(x, y1) - at(x, y0));
  return {center_in_world_, (world_from_cam_ * normalised.homogeneous()).normalized()};
}

PixelTile PixelRays::Tile(int x0, int y0) const {
  PixelTile tile{x0,  y0, std::min(x0 + kTileSidePx, width_px_), std::min(y0 + kTileSidePx, height_px_), {},
                 1.0, 0.0};
  tile.axis_in_world = At((tile.x0 + tile.x1) / 2, (tile.y0 + tile.y1) / 2).direction_in_world;
  const auto include = [&](const Ray& ray) {
    tile.cos_half_angle = std::min(tile.cos_half_angle, tile.axis_in_world.dot(ray.direction_in_world));
  };
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      include(At(x, y));
      const bool is_inner = x > tile.x0 && x + 1 < tile.x1 && y > tile.y0 && y + 1 < tile.y1;
      if (is_inner) continue;
      // Rays within a pixel are linear between its corners, so the corners are the farthest from the axis.
      for (const double across : {-0.5, 0.5})
        for (const double down : {-0.5, 0.5}) include(At(x, y, {across, down}));
    }
  }
  tile.sin_half_angle = std::sqrt(std::max(0.0, 1.0 - tile.cos_half_angle * tile.cos_half_angle));
  return tile;
}

bool PixelRays::MayMeet(const PixelTile& tile, const BoundingSphere& sphere) const {
  const Eigen::Vector3d to_sphere = sphere.center_in_world - center_in_world_;
  const double distance = to_sphere.norm();
  if (distance <= sphere.radius_mm) return true;
  const double sin_sphere = sphere.radius_mm / distance;
  const double cos_sphere = std::sqrt(1.0 - sin_sphere * sin_sphere);
  // The angle between the axes against the sum of both half angles (which stays below pi).
  const double cos_sum = tile.cos_half_angle * cos_sphere - tile.sin_half_angle * sin_sphere;
  return tile.axis_in_world.dot(to_sphere) / distance >= cos_sum - kRoundingSlack;
}

}  // namespace elbowroom::recon
