// The corner of a dark square on light ground, by the straight edges that meet in it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace elbowroom::recon {

struct CornerFit {
  Eigen::Vector2d pixel;
  double sigma_px = 0.0;
};

// The corner at `corner` of a dark square whose next corners on both sides are `before` and `after`. Each
// edge is a smooth step between two levels, fitted over the part of the side that is near the corner and half
// a module wide on both sides; `modules` is the number of modules along a side. sigma_px follows from both
// lines' covariances. Nothing: outside the picture, no such edges, or more than a module and a half off.
[[nodiscard]] std::optional<CornerFit> FitCorner(const cv::Mat& grey, const Eigen::Vector2d& corner,
                                                 const Eigen::Vector2d& before, const Eigen::Vector2d& after,
                                                 int modules);

}  // namespace elbowroom::recon
