#include "recon/segmentation/segmentation.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/segmentation/boundary.h"
#include "recon/segmentation/coverage.h"
#include "recon/segmentation/difference_kernel.h"
#include "recon/segmentation/ignored_pixels.h"
#include "recon/segmentation/mask_regions.h"

namespace elbowroom::recon {
namespace {

constexpr float kShadeNoiseLevels = 0.0F;
constexpr float kNeverObjectLevels = 512.0F;  // more than two levels can differ

// Grey levels by which a pixel may differ before it is object.
cv::Mat ThresholdOf(const BackgroundReference& background, const SegmentationOptions& options) {
  cv::Mat along_x, along_y, gradient;
  // Normalised Sobel: grey levels a pixel.
  cv::Sobel(background.mean_bgr, along_x, CV_32F, 1, 0, 3, 1.0 / 8.0, 0.0, cv::BORDER_REPLICATE);
  cv::Sobel(background.mean_bgr, along_y, CV_32F, 0, 1, 3, 1.0 / 8.0, 0.0, cv::BORDER_REPLICATE);
  cv::magnitude(along_x.reshape(1), along_y.reshape(1), gradient);
  cv::Mat threshold = background.sigma_bgr.reshape(1) * options.k_sigma;
  cv::max(threshold, options.floor_levels, threshold);
  threshold += gradient * options.edge_slack_px;
  return threshold.reshape(3);
}

}  // namespace

SegmentationStats& SegmentationStats::operator+=(const SegmentationStats& other) {
  pixels += other.pixels;
  skipped_pixels += other.skipped_pixels;
  second_looks += other.second_looks;
  return *this;
}

Segmenter::Segmenter(const BackgroundReference& background, const SegmentationOptions& options,
                     core::BitMask ignore)
    : options_(options), ignore_(std::move(ignore)), size_(background.mean_bgr.size()) {
  options.Validate();
  core::Require(background.mean_bgr.type() == CV_32FC3 && !background.mean_bgr.empty() &&
                    background.sigma_bgr.type() == CV_32FC3 && background.sigma_bgr.size() == size_,
                "a background reference has mean and sigma, CV_32FC3 of one size");
  core::Require(
      IsEmpty(ignore_) || (ignore_.width_px() == size_.width && ignore_.height_px() == size_.height),
      "an ignore mask is of its background's size");
  cv::Mat threshold_bgr = ThresholdOf(background, options);
  SetPixels(ignore_, kNeverObjectLevels, &threshold_bgr);
  packed_mean_ = PackedMean(background.mean_bgr);
  if (options.method == SegmentationMethod::kThreshold) {
    ranges_ = LevelRanges(background.mean_bgr, threshold_bgr);
  } else {
    followed_ranges_ = FollowedRanges(background.mean_bgr, threshold_bgr);
    exposure_estimator_ = ExposureEstimator(background, ignore_);
  }
}

std::optional<FixedExposure> Segmenter::ExposureOf(const cv::Mat& image_bgr) const {
  core::Require(image_bgr.type() == CV_8UC3 && image_bgr.size() == size_,
                "a picture to segment is 8-bit BGR of its background's size");
  if (options_.method == SegmentationMethod::kThreshold) return std::nullopt;
  return FixedExposure(exposure_estimator_.Estimate(image_bgr));
}

core::BitMask Segmenter::Detect(const cv::Mat& image_bgr, const std::optional<FixedExposure>& exposure,
                                BlobLimit limit, SegmentationStats* stats) const {
  const ShadeRule shade{static_cast<float>(options_.shadow_darkest),
                        static_cast<float>(options_.shadow_chroma), kShadeNoiseLevels};
  const bool rejects_shade = options_.shadows == ShadowRule::kReject;
  const int least_px =
      limit == BlobLimit::kUsual ? options_.min_blob_px : std::min(options_.min_blob_px, kSmallestBlobPx);
  std::int64_t skipped_px = 0;
  core::BitMask mask;
  if (exposure) {
    mask = DifferingPixels(followed_ranges_, *exposure, image_bgr, rejects_shade ? &shade : nullptr, least_px,
                           &skipped_px);
  } else {
    mask = rejects_shade ? DifferingPixels(ranges_, image_bgr, shade, least_px, &skipped_px)
                         : DifferingPixels(ranges_, image_bgr, least_px, &skipped_px);
  }
  if (stats != nullptr) *stats = {static_cast<std::int64_t>(image_bgr.total()), skipped_px, 0};
  if (!mask.ShowsObject()) return mask;
  // A clipped pixel may differ under another exposure even so; and a filled hole may be ignored.
  ClearPixels(ignore_, &mask);
  CleanUp(mask, least_px, options_.max_hole_px);
  ClearPixels(ignore_, &mask);
  return mask;
}

core::BitMask Segmenter::Segment(const cv::Mat& image_bgr, SegmentationStats* stats, BlobLimit limit) const {
  return Detect(image_bgr, ExposureOf(image_bgr), limit, stats);
}

core::SoftMask Segmenter::SegmentSoft(const cv::Mat& image_bgr, SegmentationStats* stats,
                                      BlobLimit limit) const {
  const std::optional<FixedExposure> exposure = ExposureOf(image_bgr);
  core::BitMask detected = Detect(image_bgr, exposure, limit, stats);
  if (!detected.ShowsObject()) return {std::move(detected), {}};
  // Objects and background are lit alike, so their contrast changes as the background does.
  const double gain = exposure ? (exposure->Gain(0) + exposure->Gain(1) + exposure->Gain(2)) / 3.0 : 1.0;
  core::SoftMask located = LocateBoundary(detected, image_bgr, packed_mean_, gain * options_.floor_levels,
                                          exposure ? &*exposure : nullptr);
  return IsEmpty(ignore_) ? std::move(located) : WithoutPixels(located, ignore_);
}

}  // namespace elbowroom::recon
