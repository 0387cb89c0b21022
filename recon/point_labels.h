// One camera's labels of a block's grid points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/camera_model.h"
#include "recon/contour_map.h"
#include "recon/hull_blocks.h"
#include "recon/label_kernel.h"

namespace elbowroom::recon {

// From a grid's points to a camera's picture plane.
class PointProjection {
 public:
  PointProjection(const core::CameraModel& camera, double focal_px, const HullGrid& grid);

  struct Point {
    Eigen::Vector2d position;
    double z_mm = 0.0;  // not positive: not in front of the camera, and the position means nothing
  };
  // The grid points of one block, as KeepByCells has them to the last bit, on every processor.
  class Block {
   public:
    Block(const PointProjection& projection, const GridPoint& corner);
    [[nodiscard]] Point At(std::size_t x, std::size_t y, std::size_t z) const {
      const std::array<double, 3>&a = along_[0][x], &b = along_[1][y], &c = along_[2][z];
      const double z_mm = (a[2] + b[2]) + c[2], per_z = 1.0 / z_mm;
      return {{((a[0] + b[0]) + c[0]) * per_z, ((a[1] + b[1]) + c[1]) * per_z}, z_mm};
    }

   private:
    std::array<std::array<std::array<double, 3>, kBlockPoints>, 3> along_;
  };

  // Clears the bits of points of the block at `corner` that are in a raster's cells of background; leaves
  // those in mixed ones and sets them in `mixed`. Points whose bits are clear aren't asked, eight at a time;
  // returns how many were.
  std::int64_t KeepByCells(const LabelRaster& raster, const GridPoint& corner, BlockBits* bits,
                           BlockBits* mixed) const;

  // Clears the bits of those points in `mixed` that the raster's contour doesn't call object, exactly.
  void SettleMixed(const ContourMap& labels, const GridPoint& corner, const BlockBits& mixed,
                   BlockBits* bits) const;

 private:
  // In cam, x and y times the focal length: of point (0, 0, 0), and of a step along each axis.
  std::array<double, 3> origin_{};
  std::array<std::array<double, 3>, 3> steps_{};
};

}  // namespace elbowroom::recon
