#include "recon/paper_methods/sweep_rays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elbowroom::recon {
namespace {

constexpr float kNoRay = std::numeric_limits<float>::quiet_NaN();

std::size_t PixelAt(int x, int y, int width_px) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
}

int TilesAlong(int pixels) { return (pixels + kSweepTilePx - 1) / kSweepTilePx; }

}  // namespace

SweepRays::SweepRays(const core::CameraModel& view)
    : width_px_(view.width_px()),
      height_px_(view.height_px()),
      camera_matrix_(view.calibration().camera_matrix),
      tiles_x_(TilesAlong(view.width_px())) {
  if (view.is_ideal()) return;
  normalised_.resize(PixelAt(0, height_px_, width_px_));
  bounds_.resize(PixelAt(0, TilesAlong(height_px_), tiles_x_));
  tbb::parallel_for(0, TilesAlong(height_px_), [&](int tile_y) {
    const int end_y = std::min((tile_y + 1) * kSweepTilePx, height_px_);
    for (int y = tile_y * kSweepTilePx; y < end_y; ++y) {
      for (int x = 0; x < width_px_; ++x) {
        Eigen::Vector2f& ray = normalised_[PixelAt(x, y, width_px_)];
        const auto found = view.NormalisedFromPixel({x, y});
        ray = found ? found->cast<float>() : Eigen::Vector2f(kNoRay, kNoRay);
        if (found) bounds_[PixelAt(x / kSweepTilePx, tile_y, tiles_x_)].extend(ray.cast<double>());
      }
    }
  });
}

Eigen::Vector2d SweepRays::IdealRay(double x, double y) const {
  const double ray_y = (y - camera_matrix_(1, 2)) / camera_matrix_(1, 1);
  return {(x - camera_matrix_(0, 2) - camera_matrix_(0, 1) * ray_y) / camera_matrix_(0, 0), ray_y};
}

Eigen::AlignedBox2d SweepRays::BoundsOf(int x0, int y0, int x1, int y1) const {
  x1 = std::min(x1, width_px_);
  y1 = std::min(y1, height_px_);
  Eigen::AlignedBox2d bounds;
  if (is_ideal()) {
    for (const int y : {y0, y1 - 1}) bounds.extend(IdealRay(x0, y)).extend(IdealRay(x1 - 1, y));
    return bounds;
  }
  for (int tile_y = y0 / kSweepTilePx; tile_y * kSweepTilePx < y1; ++tile_y) {
    for (int tile_x = x0 / kSweepTilePx; tile_x * kSweepTilePx < x1; ++tile_x) {
      bounds.extend(bounds_[PixelAt(tile_x, tile_y, tiles_x_)]);
    }
  }
  return bounds;
}

SweepTile SweepRays::TileAt(int x0, int y0) const {
  SweepTile tile;
  const Eigen::AlignedBox2d bounds = BoundsOf(x0, y0, x0 + kSweepTilePx, y0 + kSweepTilePx);
  if (!bounds.isEmpty()) tile.center = bounds.center();
  for (int i = 0; i < static_cast<int>(kSweepTilePixels); ++i) {
    const int x = x0 + i % kSweepTilePx, y = y0 + i / kSweepTilePx;
    const bool is_pixel = x < width_px_ && y < height_px_;
    Eigen::Vector2d offset(kNoRay, kNoRay);
    if (is_pixel && is_ideal()) offset = IdealRay(x, y) - tile.center;
    if (is_pixel && !is_ideal()) offset = normalised_[PixelAt(x, y, width_px_)].cast<double>() - tile.center;
    tile.dx[static_cast<std::size_t>(i)] = static_cast<float>(offset.x());
    tile.dy[static_cast<std::size_t>(i)] = static_cast<float>(offset.y());
  }
  return tile;
}

Eigen::Vector2f SweepRays::RayAt(int x, int y) const {
  return is_ideal() ? IdealRay(x, y).cast<float>() : normalised_[PixelAt(x, y, width_px_)];
}

}  // namespace elbowroom::recon
