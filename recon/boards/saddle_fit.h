// The place where four squares of a board meet, to a small part of a pixel.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace elbowroom::recon {

// How a board lies in the picture around one of its points.
struct LocalLattice {
  Eigen::Vector2d pixel;               // of the point
  Eigen::Matrix2d pixel_from_squares;  // first column: one square along the columns; second: along the rows
};

struct SaddleFitOptions {
  // +1: the squares before and after the point on both axes are the light ones; -1: the dark ones.
  int sign = 1;
  // Light squares are empty up to this many squares from their sides; a marker may be further in. 0.5: empty.
  double empty_squares = 0.5;
};

struct SaddleFit {
  Eigen::Vector2d pixel;
  double sigma_px = 0.0;
  double contrast = 0.0;  // between light and dark, in grey levels
};

// Fits light = c + d s(l1/w) s(l2/w) to the levels around `near`: l1 and l2 are the distances from two lines,
// s is a smooth step of width w. Window: 0.42 of a square to each side, as the square lies in the picture, at
// most 12 px. If `near` is within half a pixel, the crossing is right whatever the blur, since window and
// pattern are symmetric about it (saddle_fit_test); from further away, fit again from the result. sigma_px is
// that of the crossing, from the residuals. Nothing: outside the picture, not such a crossing, further than
// 0.35 of a square from `near`.
[[nodiscard]] std::optional<SaddleFit> FitSaddle(const cv::Mat& grey, const LocalLattice& near,
                                                 const SaddleFitOptions& options);

}  // namespace elbowroom::recon
