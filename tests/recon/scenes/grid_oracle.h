// The undistortion grid by its definition: corners through the lens, a projected texture between
// (recon::PlaneGrid).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::recon {

// A position in a camera's picture, and how far an implementation's may be off.
struct PicturePosition {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();
  double error_px = 0.0;
};

// How a grid's positions are rounded.
struct GridRoundings {
  double roundings = 0.0;  // of single precision, on the way to a position
  double corner_px = 0.0;  // by which the view's rasteriser may move a triangle's corner
};

// Keeps a reference to the view.
class GridOracle {
 public:
  // `cells` a side; >= 1.
  GridOracle(const core::CameraModel& view, int cells);

  // Where the camera sees the point of pixel (x, y) on the plane at `depth_mm`. Nothing: it is behind
  // the camera, or a corner of its triangle has no ray. One answer for each triangle that the pixel's centre
  // may be counted to.
  [[nodiscard]] std::vector<std::optional<PicturePosition>> PositionsOf(const core::CameraModel& camera,
                                                                        int x, int y, double depth_mm,
                                                                        const GridRoundings& rounded) const;

 private:
  // One of the two triangles of a cell.
  struct Half {
    int column = 0, row = 0;
    bool is_upper_left = false;
    [[nodiscard]] bool operator==(const Half&) const = default;
  };
  [[nodiscard]] Half HalfAt(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] std::optional<PicturePosition> PositionIn(const Half& half, const core::CameraModel& camera,
                                                          const Eigen::Vector2d& pixel, double depth_mm,
                                                          const GridRoundings& rounded) const;

  const core::CameraModel& view_;
  int cells_;
  Eigen::Vector2d cell_px_;
  std::vector<std::optional<Eigen::Vector2d>> node_rays_;  // normalised, row by row
};

}  // namespace elbowroom::recon
