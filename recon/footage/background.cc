#include "recon/footage/background.h"

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

// 255^2 * kMostFrames must fit the sums of squares.
static_assert(std::uint64_t{255} * 255 * BackgroundAccumulator::kMostFrames < (std::uint64_t{1} << 32U));

void AddRow(const std::uint8_t* values, std::uint32_t* sum, std::uint32_t* sum_squares, int n) {
  for (int i = 0; i < n; ++i) {
    const std::uint32_t value = values[i];
    sum[i] += value;
    sum_squares[i] += value * value;
  }
}

}  // namespace

void BackgroundAccumulator::Add(const cv::Mat& image_bgr) {
  core::Require(image_bgr.type() == CV_8UC3 && !image_bgr.empty(), "a background frame is 8-bit BGR");
  core::Require(frames_ < kMostFrames, "a background has at most kMostFrames frames");
  if (frames_ == 0) {
    sum_ = cv::Mat::zeros(image_bgr.size(), CV_32SC3);
    sum_squares_ = cv::Mat::zeros(image_bgr.size(), CV_32SC3);
  }
  core::Require(image_bgr.size() == sum_.size(), "all frames of a background have one size");
  for (int y = 0; y < image_bgr.rows; ++y) {
    AddRow(image_bgr.ptr<std::uint8_t>(y), sum_.ptr<std::uint32_t>(y), sum_squares_.ptr<std::uint32_t>(y),
           image_bgr.cols * 3);
  }
  ++frames_;
}

BackgroundReference BackgroundAccumulator::Reference() const {
  core::Require(frames_ > 0, "a background reference needs a frame");
  BackgroundReference reference{cv::Mat(sum_.size(), CV_32FC3), cv::Mat(sum_.size(), CV_32FC3), frames_};
  const auto n = static_cast<std::uint64_t>(frames_);
  const double degrees_of_freedom = frames_ > 1 ? static_cast<double>(n * (n - 1)) : 1.0;
  for (int y = 0; y < sum_.rows; ++y) {
    const auto* sum = sum_.ptr<std::uint32_t>(y);
    const auto* sum_squares = sum_squares_.ptr<std::uint32_t>(y);
    auto* mean = reference.mean_bgr.ptr<float>(y);
    auto* sigma = reference.sigma_bgr.ptr<float>(y);
    for (int i = 0; i < sum_.cols * 3; ++i) {
      const std::uint64_t s = sum[i];
      const std::uint64_t scatter = n * sum_squares[i] - s * s;  // never negative (Cauchy-Schwarz)
      mean[i] = static_cast<float>(static_cast<double>(s) / static_cast<double>(n));
      sigma[i] = static_cast<float>(std::sqrt(static_cast<double>(scatter) / degrees_of_freedom));
    }
  }
  return reference;
}

}  // namespace elbowroom::recon
