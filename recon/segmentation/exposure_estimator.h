// Which change of light or exposure a picture shows against its background reference, from a sample of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "core/bit_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/exposure.h"

namespace elbowroom::recon {

// Chooses up to kSamples (or fewer, as asked for) pixels of the background once, one in each square of a
// grid, where the background is flattest and no channel is clipped. It then finds the lines picture = gain *
// background + offset, one a channel, that most of them agree with: pixels of objects are outliers, and the
// noise of background pixels is known (docs/segmentation.md has the derivation). It holds as long as well
// over half of the sample is background (tests/recon/segmentation/exposure_estimator_test.cc). Immutable; the
// same on every machine.
class ExposureEstimator {
 public:
  static constexpr int kSamples = 2048;
  static constexpr std::size_t kLeastSamples = 64;

  ExposureEstimator() = default;

  // Pixels of `ignore` (of the background's size, or without a size) are never chosen. Throws:
  // PreconditionError for a background without mean or sigma, or for an `ignore` of another size.
  explicit ExposureEstimator(const BackgroundReference& background, const core::BitMask& ignore = {},
                             int samples = kSamples);

  // The change; none, and an agreeing share of zero, where fewer than kLeastSamples pixels agree with any. A
  // channel in which all are clipped keeps a gain of 1. Where the background has one level only, an offset
  // can't be told from a gain, and all is gain. Throws: PreconditionError unless `image_bgr` is CV_8UC3 of
  // the background's size.
  [[nodiscard]] ExposureChange Estimate(const cv::Mat& image_bgr) const;

  [[nodiscard]] std::span<const cv::Point> places() const { return places_; }

 private:
  using Levels = std::array<std::vector<float>, 3>;  // a channel each, in the order of places_
  struct Line {
    float gain = 1.0F;
    float offset = 0.0F;
  };
  using Lines = std::array<Line, 3>;
  static constexpr std::size_t kBins = 8;  // of as many places each, from dark to bright

  void ChoosePlaces(const cv::Mat& mean_bgr, const core::BitMask& ignore, int samples);
  void SortIntoBins();
  [[nodiscard]] Lines FirstLines(const Levels& picture) const;
  [[nodiscard]] float MisfitOf(const Lines& lines, const Levels& scored) const;
  [[nodiscard]] std::size_t Refine(double cut2, const Levels& picture, Lines* lines) const;

  cv::Size size_;
  std::vector<cv::Point> places_;
  Levels mean_;
  Levels per_variance_;  // 1 / variance of a picture's level about the mean; 0 where clipped
  // For the first lines: the places of each bin, and each bin's median of the background.
  std::array<std::vector<std::uint16_t>, kBins> bins_;
  std::array<std::array<float, 3>, kBins> bin_mean_{};
  // And the places that the lines are scored by, with mean_ and per_variance_ there.
  std::vector<std::uint16_t> scored_;
  Levels scored_mean_, scored_per_variance_;
  std::array<double, 3> mean_variance_{};  // of the error of the mean itself
};

}  // namespace elbowroom::recon
