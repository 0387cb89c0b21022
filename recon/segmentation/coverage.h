// How much of a pixel on a silhouette's boundary is object.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

#include "core/bit_mask.h"
#include "recon/segmentation/coverage_kernel.h"

namespace elbowroom::recon {

// A background's mean (CV_32FC3, 0..255) to a quarter of a grey level, a pixel in four bytes (CV_32SC1): blue
// in the lowest ten bits, then green, then red.
[[nodiscard]] cv::Mat PackedMean(const cv::Mat& mean_bgr);

struct PixelPlace {
  int x = 0;
  int y = 0;
};

// A level as core::SoftMask has them; at least 128 where at least half of the pixel is object.
struct Coverage {
  std::uint8_t level = 0;
  bool is_known = false;  // false where object and background are too alike
};

// Coverage in one picture, given which pixels were detected (docs/segmentation.md). Thread: any; the picture,
// mean and mask must outlive it.
class CoverageEstimator {
 public:
  CoverageEstimator(const core::BitMask& detected, const cv::Mat& image_bgr, const cv::Mat& packed_mean,
                    double least_contrast_levels);

  // One coverage a place. Works in batches: first a batch's pixels are read, then its levels are reckoned.
  void Estimate(std::span<const PixelPlace> places, std::span<Coverage> coverages) const;

 private:
  void Read(PixelPlace place, std::size_t i, CoverageSamples* samples) const;
  void ReadObject(PixelPlace place, PixelPlace first, PixelPlace second, std::size_t i,
                  CoverageSamples* samples) const;
  [[nodiscard]] std::uint32_t StrongestAround(PixelPlace place) const;

  [[nodiscard]] bool IsPixel(PixelPlace p) const {
    return static_cast<unsigned>(p.x) < static_cast<unsigned>(width_) &&
           static_cast<unsigned>(p.y) < static_cast<unsigned>(height_);
  }
  [[nodiscard]] bool IsObject(PixelPlace p) const { return IsPixel(p) && detected_.At(p.x, p.y); }
  [[nodiscard]] std::uint32_t Image(PixelPlace p) const {
    const std::uint8_t* at = image_ + static_cast<std::size_t>(p.y) * image_stride_ + 3 * p.x;
    return at[0] | static_cast<std::uint32_t>(at[1]) << 8U | static_cast<std::uint32_t>(at[2]) << 16U;
  }
  [[nodiscard]] std::uint32_t Mean(PixelPlace p) const {
    return mean_[static_cast<std::size_t>(p.y) * mean_stride_ + static_cast<std::size_t>(p.x)];
  }

  const core::BitMask& detected_;
  const std::uint8_t* image_;
  std::size_t image_stride_;
  const std::uint32_t* mean_;
  std::size_t mean_stride_;
  int width_, height_;
  float least_contrast2_;
};

}  // namespace elbowroom::recon
