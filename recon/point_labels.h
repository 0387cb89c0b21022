// One camera's labels of a block's grid points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/camera_model.h"
#include "recon/contour_map.h"
#include "recon/hull_blocks.h"

namespace elbowroom::recon {

inline constexpr int kBlockPoints = kBlockCells + 1;  // grid points on a side of a block

// A bit for each of a block's kBlockPoints^3 grid points.
struct BlockBits {
  static constexpr std::size_t kLayerPoints = kBlockPoints * kBlockPoints;
  static constexpr std::size_t kLayerBytes = (kLayerPoints + 7) / 8;
  using Layer = std::array<std::uint8_t, kLayerBytes>;  // point (x, y): bit x + kBlockPoints * y
  std::array<Layer, kBlockPoints> layers{};             // by z

  // The points (x, y, z), bit x each.
  [[nodiscard]] unsigned Row(int y, int z) const {
    const auto bit = static_cast<unsigned>(y * kBlockPoints);
    const Layer& layer = layers[static_cast<std::size_t>(z)];
    const unsigned pair = layer[bit / 8] | static_cast<unsigned>(layer[bit / 8 + 1]) << 8U;
    return (pair >> bit % 8) & ((1U << kBlockPoints) - 1U);
  }
};

// From a grid's points to a camera's picture plane.
class PointProjection {
 public:
  PointProjection(const core::CameraModel& camera, double focal_px, const HullGrid& grid);

  struct Point {
    Eigen::Vector2d position;
    double z_mm = 0.0;  // not positive: not in front of the camera, and the position means nothing
  };
  // The same to the last bit as KeepObject has it, on every processor.
  [[nodiscard]] Point Of(const GridPoint& p) const;

  // Clears the bits of points of the block at `corner` that `labels` doesn't call object, exactly. `raster`
  // is that of `labels`. Points whose bits are clear aren't asked, eight at a time; returns how many were.
  std::int64_t KeepObject(const ContourMap& labels, const LabelRaster& raster, const GridPoint& corner,
                          BlockBits* bits) const;

 private:
  // In cam, x and y times the focal length: of point (0, 0, 0), and of a step along each axis.
  Eigen::Vector3d origin_;
  std::array<Eigen::Vector3d, 3> steps_;
};

}  // namespace elbowroom::recon
