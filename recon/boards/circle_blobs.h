// Dark ellipses in a picture.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace elbowroom::recon {

struct CircleBlob {
  Eigen::Vector2d pixel;            // its centre of area
  Eigen::Matrix2d unit_from_pixel;  // takes its rim, relative to its centre, to the unit circle
  double area_px2 = 0.0;
};

// Dark on lighter ground, of at least 20 px^2. Thread: any.
[[nodiscard]] std::vector<CircleBlob> FindCircleBlobs(const cv::Mat& grey);

struct CenterFit {
  Eigen::Vector2d pixel;
  double sigma_px = 0.0;
  double contrast = 0.0;  // between light and dark, in grey levels
};

// The centre of a blob's area by its grey levels; a blurred rim counts by its share of dark. sigma_px: from
// the noise of the levels around it. Nothing: partly outside the picture, or not dark on light.
[[nodiscard]] std::optional<CenterFit> FitCenter(const cv::Mat& grey, const CircleBlob& blob);

}  // namespace elbowroom::recon
