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
  // The grid points of one block, as KeepObject has them to the last bit, on every processor.
  class Block {
   public:
    Block(const PointProjection& projection, const GridPoint& corner);
    [[nodiscard]] Point At(const std::array<std::size_t, 3>& p) const {
      const std::array<double, 3>&a = along_[0][p[0]], &b = along_[1][p[1]], &c = along_[2][p[2]];
      const double z_mm = (a[2] + b[2]) + c[2], per_z = 1.0 / z_mm;
      return {{((a[0] + b[0]) + c[0]) * per_z, ((a[1] + b[1]) + c[1]) * per_z}, z_mm};
    }

   private:
    std::array<std::array<std::array<double, 3>, kBlockPoints>, 3> along_;
  };

  // Clears the bits of points of the block at `corner` that `labels` doesn't call object, exactly. `raster`
  // is that of `labels`. Points whose bits are clear aren't asked, eight at a time; returns how many were.
  std::int64_t KeepObject(const ContourMap& labels, const LabelRaster& raster, const GridPoint& corner,
                          BlockBits* bits) const;

 private:
  // In cam, x and y times the focal length: of point (0, 0, 0), and of a step along each axis.
  std::array<double, 3> origin_{};
  std::array<std::array<double, 3>, 3> steps_{};
};

}  // namespace elbowroom::recon
