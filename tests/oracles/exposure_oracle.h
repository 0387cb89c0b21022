// A change of exposure found and applied slowly, in plain code: what the fast ways are held to.
#pragma once

#include <opencv2/core/mat.hpp>

#include "core/bit_mask.h"
#include "recon/segmentation/exposure.h"

namespace elbowroom::oracles {

// From the counts of all pairs of background level and picture level: a line through the medians of the
// picture's levels over the background's levels, which is then refitted to the pixels near it. It holds as
// long as well over half of the picture is background. A background without enough contrast for a line (one
// grey wall) gets a gain only. Clipped pixels are left out. Throws: PreconditionError unless CV_8UC3 and
// CV_32FC3 of one size.
[[nodiscard]] recon::ExposureChange EstimateExposureSlowly(const cv::Mat& image_bgr, const cv::Mat& mean_bgr);

// CV_32FC3: the background as it would look after the change, within 0..255.
[[nodiscard]] cv::Mat WithExposure(const cv::Mat& mean_bgr, const recon::ExposureChange& change);

// Whether a level is outside of [mean - threshold, mean + threshold] after the change, whose ends are clipped
// as a sensor clips, by more than `by_levels`. In real numbers.
[[nodiscard]] bool IsOutsideExactly(double level, double mean, double threshold, double gain,
                                    double offset_levels, double by_levels = 0.0);

// The same of each pixel, true if a channel is outside, with the rounding that docs/segmentation.md gives:
// what DifferingPixels must give without a rule for shade, bit by bit.
[[nodiscard]] core::BitMask OutsidePixels(const cv::Mat& image_bgr, const cv::Mat& mean_bgr,
                                          const cv::Mat& threshold_bgr, const recon::FixedExposure& exposure);

}  // namespace elbowroom::oracles
