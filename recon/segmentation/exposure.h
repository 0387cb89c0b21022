// A change of exposure of a whole picture against its background reference: gain and offset a channel.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

namespace elbowroom::recon {

// image = gain * mean + offset_levels, a channel (blue, green, red).
struct ExposureChange {
  std::array<double, 3> gain{1.0, 1.0, 1.0};
  std::array<double, 3> offset_levels{0.0, 0.0, 0.0};
};

// The estimate is robust: it holds as long as well over half of the picture is background. It is a line
// through the medians of the picture's levels over the background's levels, which is then refitted to the
// pixels near it. A background without enough contrast for a line (one grey wall) gets a gain only. Saturated
// pixels are left out. Throws: PreconditionError unless CV_8UC3 and CV_32FC3 of one size.
[[nodiscard]] ExposureChange EstimateExposure(const cv::Mat& image_bgr, const cv::Mat& mean_bgr);

// CV_32FC3: the background as it would look after the change, within 0..255.
[[nodiscard]] cv::Mat WithExposure(const cv::Mat& mean_bgr, const ExposureChange& change);

}  // namespace elbowroom::recon
