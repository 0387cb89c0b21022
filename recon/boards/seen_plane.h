// A plane as a camera with one radial term of distortion sees it: what the points of a board must agree with.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "recon/boards/homography.h"

namespace elbowroom::recon {

// pixel = center + r * stretch, where r = (p - center) / stretch is undistorted by r / (1 + bend |r|^2)
// (division model, Fitzgibbon 2001) into the image of a homography.
class SeenPlane {
 public:
  SeenPlane(const Eigen::Matrix3d& undistorted_from_board, double bend, Eigen::Vector2d center_px,
            double stretch_px)
      : undistorted_from_board_(undistorted_from_board),
        bend_(bend),
        center_px_(std::move(center_px)),
        stretch_px_(stretch_px) {}

  // The pixel of a point of the board's plane.
  [[nodiscard]] Eigen::Vector2d Project(const Eigen::Vector2d& x_in_board) const;
  // The derivative of Project, numerically.
  [[nodiscard]] Eigen::Matrix2d PixelFromBoard(const Eigen::Vector2d& x_in_board) const;

 private:
  Eigen::Matrix3d undistorted_from_board_;
  double bend_;
  Eigen::Vector2d center_px_;
  double stretch_px_;
};

// The plane that fits pairs of (point in board, pixel) best, in a picture of that size. The bend is looked
// for only if there are 12 pairs or more. Nothing: fewer than four pairs, or points on a line.
[[nodiscard]] std::optional<SeenPlane> FitSeenPlane(const std::vector<PointPair>& pairs, int width_px,
                                                    int height_px);

// The places in `pairs` of those that agree with one plane, in their order: points further from it than five
// times the median and than 0.5 px, or than a fifth of a square, are left out one round after another.
[[nodiscard]] std::vector<std::size_t> AgreeingPairs(const std::vector<PointPair>& pairs, double square_mm,
                                                     int width_px, int height_px);

}  // namespace elbowroom::recon
