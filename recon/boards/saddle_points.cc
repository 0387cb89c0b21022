#include "recon/boards/saddle_points.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr std::size_t kMostSaddles = 1000;
constexpr double kSmoothingPx = 1.2;
// An ideal crossing between levels m - d and m + d, smoothed by s, has the strength (2 d / (pi s^2))^2. Half
// a picture's sharpness is left for its own blur.
constexpr double kLeastHalfContrast = 2.5;
constexpr double kTwoByPi = 0.6366;

double LeastStrength() {
  const double slope = kTwoByPi * kLeastHalfContrast / (kSmoothingPx * kSmoothingPx);
  return slope * slope;
}

// The strength at each pixel of a smoothed picture; 0 along its border.
cv::Mat StrengthOf(const cv::Mat& smooth) {
  cv::Mat strength(smooth.size(), CV_32F, cv::Scalar(0.0));
  for (int y = 1; y + 1 < smooth.rows; ++y) {
    const auto* above = smooth.ptr<float>(y - 1);
    const auto* here = smooth.ptr<float>(y);
    const auto* below = smooth.ptr<float>(y + 1);
    auto* out = strength.ptr<float>(y);
    for (int x = 1; x + 1 < smooth.cols; ++x) {
      const float xx = here[x - 1] - 2.0F * here[x] + here[x + 1];
      const float yy = above[x] - 2.0F * here[x] + below[x];
      const float xy = 0.25F * (above[x - 1] - above[x + 1] - below[x - 1] + below[x + 1]);
      out[x] = xy * xy - xx * yy;
    }
  }
  return strength;
}

// The saddle's place by the zero of the gradient, at most a pixel from the strongest pixel.
SaddlePoint SaddleAt(const cv::Mat& smooth, const cv::Mat& strength, int x, int y, int halvings) {
  const auto at = [&](int dx, int dy) -> double { return smooth.at<float>(y + dy, x + dx); };
  Matrix2d curvature;
  curvature(0, 0) = at(-1, 0) - 2.0 * at(0, 0) + at(1, 0);
  curvature(1, 1) = at(0, -1) - 2.0 * at(0, 0) + at(0, 1);
  curvature(0, 1) = curvature(1, 0) = 0.25 * (at(-1, -1) - at(1, -1) - at(-1, 1) + at(1, 1));
  const Vector2d gradient(0.5 * (at(1, 0) - at(-1, 0)), 0.5 * (at(0, 1) - at(0, -1)));
  const Vector2d step = (-curvature.inverse() * gradient).cwiseMax(-1.0).cwiseMin(1.0);
  const double scale = std::ldexp(1.0, halvings);
  const Vector2d pixel = (Vector2d(x, y) + step + Vector2d::Constant(0.5)) * scale - Vector2d::Constant(0.5);
  return {pixel, curvature / (scale * scale), strength.at<float>(y, x)};
}

}  // namespace

std::vector<SaddlePoint> FindSaddlePoints(const cv::Mat& grey, int halvings) {
  cv::Mat smooth, grown;
  if (halvings == 0) {
    grey.convertTo(smooth, CV_32F);
  } else {
    cv::Mat smaller;
    cv::resize(grey, smaller,
               cv::Size(std::max(1, grey.cols >> halvings), std::max(1, grey.rows >> halvings)), 0.0, 0.0,
               cv::INTER_AREA);
    smaller.convertTo(smooth, CV_32F);
  }
  cv::GaussianBlur(smooth, smooth, cv::Size(7, 7), kSmoothingPx, kSmoothingPx, cv::BORDER_REPLICATE);
  const cv::Mat strength = StrengthOf(smooth);
  cv::dilate(strength, grown, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(5, 5)));
  const auto least = static_cast<float>(LeastStrength());
  std::vector<SaddlePoint> saddles;
  for (int y = 1; y + 1 < strength.rows; ++y) {
    const auto* here = strength.ptr<float>(y);
    const auto* most = grown.ptr<float>(y);
    for (int x = 1; x + 1 < strength.cols; ++x)
      if (here[x] > least && here[x] >= most[x])
        saddles.push_back(SaddleAt(smooth, strength, x, y, halvings));
  }
  const auto is_stronger = [](const SaddlePoint& a, const SaddlePoint& b) { return a.strength > b.strength; };
  const std::size_t kept = std::min(saddles.size(), kMostSaddles);
  std::partial_sort(saddles.begin(), saddles.begin() + static_cast<std::ptrdiff_t>(kept), saddles.end(),
                    is_stronger);
  saddles.resize(kept);
  return saddles;
}

}  // namespace elbowroom::recon
