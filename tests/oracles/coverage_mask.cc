#include "tests/oracles/coverage_mask.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "recon/synthetic/camera_view.h"

namespace elbowroom::oracles {
namespace {

constexpr int kReachPx = 3;

bool IsNearBoundary(const core::BitMask& mask, int x, int y) {
  const int x0 = std::max(x - kReachPx, 0), x1 = std::min(x + kReachPx, mask.width_px() - 1);
  const int y0 = std::max(y - kReachPx, 0), y1 = std::min(y + kReachPx, mask.height_px() - 1);
  for (int j = y0; j <= y1; ++j)
    for (int i = x0; i <= x1; ++i)
      if (mask.At(i, j) != mask.At(x, y)) return true;
  return false;
}

// With the ball around it, which tells most rays that they miss it.
struct BoundedSolid {
  recon::Solid solid;
  recon::BoundingSphere ball;
};

bool MissesBall(const recon::BoundingSphere& ball, const recon::Ray& ray) {
  constexpr double kSlackMm = 1e-3;  // for rounding
  const double aside_mm = ray.direction_in_world.cross(ball.center_in_world - ray.origin_in_world).norm();
  return aside_mm > ball.radius_mm + kSlackMm;
}

bool IsHit(const core::CameraModel& camera, std::span<const BoundedSolid> solids,
           const Eigen::Vector2d& pixel) {
  const auto normalised = camera.NormalisedFromPixel(pixel);
  if (!normalised) return false;
  const recon::Ray ray{
      camera.center_in_world(),
      (camera.cam_from_world().rotation.transpose() * normalised->homogeneous()).normalized()};
  return std::ranges::any_of(solids, [&](const BoundedSolid& s) {
    return !MissesBall(s.ball, ray) && recon::FirstHit(s.solid, ray).has_value();
  });
}

std::uint8_t LevelAt(const core::CameraModel& camera, std::span<const BoundedSolid> solids, int x, int y,
                     double footprint_px) {
  int hits = 0;
  for (int j = 0; j < kCoverageSamples; ++j) {
    for (int i = 0; i < kCoverageSamples; ++i) {
      const Eigen::Vector2d in_pixel((i + 0.5) / kCoverageSamples - 0.5, (j + 0.5) / kCoverageSamples - 0.5);
      hits += IsHit(camera, solids, Eigen::Vector2d(x, y) + footprint_px * in_pixel) ? 1 : 0;
    }
  }
  return static_cast<std::uint8_t>(std::lround(255.0 * hits / (kCoverageSamples * kCoverageSamples)));
}

}  // namespace

core::BitMask CenterMask(const core::CameraModel& camera, std::span<const recon::Solid> solids) {
  return recon::CameraView(camera, 1).TrueMask(solids);
}

core::SoftMask CoverageMask(const core::CameraModel& camera, std::span<const recon::Solid> solids,
                            double footprint_px) {
  const core::BitMask centers = CenterMask(camera, solids);
  std::vector<BoundedSolid> bounded;
  for (const recon::Solid& solid : solids) bounded.push_back({solid, recon::BoundingSphereOf(solid)});
  const int width = camera.width_px(), height = camera.height_px();
  std::vector<std::uint8_t> level(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      level[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          IsNearBoundary(centers, x, y) ? LevelAt(camera, bounded, x, y, footprint_px)
          : centers.At(x, y)            ? 255
                                        : 0;
    }
  });
  core::SoftMask result{core::BitMask(width, height), {}};
  const auto level_at = [&](int x, int y) {
    return level[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) result.mask.Set(x, y, level_at(x, y) >= 128);
  const core::BitMask boundary = core::BoundaryPixels(result.mask);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (boundary.At(x, y)) result.levels.push_back(level_at(x, y));
  return result;
}

}  // namespace elbowroom::oracles
