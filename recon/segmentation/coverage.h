// How much of a pixel on a silhouette's boundary is object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

#include "core/bit_mask.h"
#include "recon/segmentation/coverage_kernel.h"
#include "recon/segmentation/coverage_reading.h"

namespace elbowroom::recon {

// A background's mean (CV_32FC3, 0..255) to a quarter of a grey level, a pixel in four bytes (CV_32SC1): blue
// in the lowest ten bits, then green, then red.
[[nodiscard]] cv::Mat PackedMean(const cv::Mat& mean_bgr);

// Coverage in one picture, given which pixels were detected (docs/segmentation.md). Thread: any; the picture,
// mean and mask must outlive it.
class CoverageEstimator {
 public:
  // Throws: PreconditionError unless the picture is CV_8UC3 and the mean CV_32SC1, both of the mask's size.
  // `exposure`: the change that is applied to the mean first, or null.
  CoverageEstimator(const core::BitMask& detected, const cv::Mat& image_bgr, const cv::Mat& packed_mean,
                    double least_contrast_levels, const FixedExposure* exposure = nullptr);

  // A level for each place, as ReckonCoverage. Works in batches: first a batch's pixels are read, then its
  // levels are reckoned.
  void Estimate(std::span<const PixelPlace> places, std::span<std::uint32_t> levels) const;

 private:
  void ReadStrongest(std::span<const PixelPlace> places, std::uint64_t which, CoverageSamples* samples) const;
  [[nodiscard]] std::uint32_t StrongestAround(PixelPlace place) const;
  [[nodiscard]] std::uint32_t Image(int x, int y) const {
    const std::uint8_t* at = picture_.image + static_cast<std::ptrdiff_t>(y) * picture_.image_stride + 3 * x;
    return at[0] | static_cast<std::uint32_t>(at[1]) << 8U | static_cast<std::uint32_t>(at[2]) << 16U;
  }
  [[nodiscard]] std::uint32_t Mean(int x, int y) const {
    const std::uint32_t mean = picture_.mean[static_cast<std::ptrdiff_t>(y) * picture_.mean_stride + x];
    return picture_.exposure == nullptr ? mean : WithExposure(mean, *picture_.exposure);
  }

  CoveragePicture picture_;
  float least_contrast2_;
};

}  // namespace elbowroom::recon
