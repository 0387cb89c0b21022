// The viewing rays of a camera, tile by tile, as the plane sweep takes them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::recon {

inline constexpr int kSweepTilePx = 16;
inline constexpr std::size_t kSweepTilePixels = 256;

// The rays of one tile, row by row: normalised position center + (dx, dy); NaN where the lens has no ray.
struct SweepTile {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  alignas(64) std::array<float, kSweepTilePixels> dx{};
  alignas(64) std::array<float, kSweepTilePixels> dy{};
};

// Without distortion rays follow from the pixel; with it, every pixel is undistorted once, in parallel.
// Knows the lens, not the pose. Immutable. Thread: any.
class SweepRays {
 public:
  explicit SweepRays(const core::CameraModel& view);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] bool is_ideal() const { return normalised_.empty(); }

  // Encloses the rays of all pixels [x0, x1) x [y0, y1); empty when there are none. x0 and y0 are multiples
  // of kSweepTilePx, and so are x1 and y1, which may lie beyond the picture, unless they are the picture's
  // size.
  [[nodiscard]] Eigen::AlignedBox2d BoundsOf(int x0, int y0, int x1, int y1) const;

  // The tile whose first pixel is (x0, y0), multiples of kSweepTilePx.
  [[nodiscard]] SweepTile TileAt(int x0, int y0) const;

  // Normalised position of a pixel's ray; NaN where there is none.
  [[nodiscard]] Eigen::Vector2f RayAt(int x, int y) const;

 private:
  [[nodiscard]] Eigen::Vector2d IdealRay(double x, double y) const;

  int width_px_;
  int height_px_;
  Eigen::Matrix3d camera_matrix_;
  int tiles_x_;
  std::vector<Eigen::Vector2f> normalised_;  // row-major; empty for an ideal lens
  std::vector<Eigen::AlignedBox2d> bounds_;  // one a tile
};

}  // namespace elbowroom::recon
