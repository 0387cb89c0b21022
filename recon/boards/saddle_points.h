// Where the grey levels of a picture form saddles, as they do where four squares of a board meet.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace elbowroom::recon {

struct SaddlePoint {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d curvature;  // second derivatives of the smoothed grey levels, per px^2
  double strength = 0.0;      // minus the determinant of `curvature`
};

// The picture made smaller by 2^halvings, so that saddles of large or blurred squares are found. Pixels of
// the result are those of `grey`; their error is up to a pixel of the smaller picture. At most 1,000, the
// strongest first. Thread: any.
[[nodiscard]] std::vector<SaddlePoint> FindSaddlePoints(const cv::Mat& grey, int halvings);

}  // namespace elbowroom::recon
