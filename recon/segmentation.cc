#include "recon/segmentation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/error.h"
#include "recon/exposure.h"
#include "recon/mask_image.h"

namespace elbowroom::recon {
namespace {

constexpr std::uint8_t kObject = 255;

void RequireInRange(bool holds, std::string_view option, double value, std::string_view range) {
  if (holds) return;
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("segmentation: {} is {}, but must be {}", option, value, range));
}

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

// The whole levels within `threshold` of `mean`: a picture's levels are whole, so asking lowest <= I <=
// highest is the same as asking |I - mean| <= threshold.
void LevelsWithin(const cv::Mat& mean_bgr, const cv::Mat& threshold_bgr, cv::Mat& lowest_bgr,
                  cv::Mat& highest_bgr) {
  lowest_bgr.create(mean_bgr.size(), CV_8UC3);
  highest_bgr.create(mean_bgr.size(), CV_8UC3);
  for (int y = 0; y < mean_bgr.rows; ++y) {
    const auto* mean = mean_bgr.ptr<float>(y);
    const auto* threshold = threshold_bgr.ptr<float>(y);
    auto* lowest = lowest_bgr.ptr<std::uint8_t>(y);
    auto* highest = highest_bgr.ptr<std::uint8_t>(y);
    for (int i = 0; i < mean_bgr.cols * 3; ++i) {
      // Sums of two floats are exact in double. Rounded by hand: std::ceil and std::floor are calls on plain
      // x86-64.
      const double low = std::clamp(static_cast<double>(mean[i]) - threshold[i], 0.0, 255.0);
      const double high = std::clamp(static_cast<double>(mean[i]) + threshold[i], 0.0, 255.0);
      const int below_low = static_cast<int>(low);
      lowest[i] = static_cast<std::uint8_t>(below_low + (below_low < low ? 1 : 0));
      highest[i] = static_cast<std::uint8_t>(static_cast<int>(high));
    }
  }
}

// Clears the pixels that are the background in shade. With I the pixel, B the background's mean and
// g = I.B / B.B the share of its brightness that is left, it is shade where darkest <= g < 1 and the rest
// I - g B, which is change of colour, is short beside g B.
void ClearShadowRow(const std::uint8_t* image, const float* mean, float darkest, float chroma,
                    std::uint8_t* object, int width) {
  for (int x = 0; x < width; ++x) {
    if (object[x] == 0) continue;
    float ib = 0.0F, bb = 0.0F, ii = 0.0F;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<float>(image[3 * x + c]);
      const float b = mean[3 * x + c];
      ib += i * b, bb += b * b, ii += i * i;
    }
    // |I - g B|^2 = I.I - (I.B)^2 / B.B and |g B|^2 = (I.B)^2 / B.B; both times B.B.
    const bool is_shade = ib >= darkest * bb && ib < bb && ii * bb - ib * ib < chroma * chroma * ib * ib;
    if (is_shade) object[x] = 0;
  }
}

// Regions of `value` smaller than `least_px` take the other value.
void RemoveSmallRegions(cv::Mat& object, std::uint8_t value, int least_px, int connectivity) {
  if (least_px <= 1) return;
  cv::Mat labels, stats, centroids;
  // Nothing changes outside the object's bounds; a border of background around them keeps the outside one
  // region.
  const cv::Rect bounds = cv::boundingRect(object);
  const cv::Rect picture(0, 0, object.cols, object.rows);
  cv::Mat part = object(cv::Rect(bounds.x - 1, bounds.y - 1, bounds.width + 2, bounds.height + 2) & picture);
  if (bounds.empty()) return;
  const cv::Mat region = value == kObject ? part : cv::Mat(part == 0);
  const int count = cv::connectedComponentsWithStats(region, labels, stats, centroids, connectivity, CV_32S);
  std::vector<std::uint8_t> is_small(static_cast<std::size_t>(count), 0);
  for (int i = 1; i < count; ++i) {
    is_small[static_cast<std::size_t>(i)] = stats.at<int>(i, cv::CC_STAT_AREA) < least_px ? 1 : 0;
  }
  const std::uint8_t other = value == kObject ? 0 : kObject;
  for (int y = 0; y < part.rows; ++y) {
    const int* label = labels.ptr<int>(y);
    auto* row = part.ptr<std::uint8_t>(y);
    for (int x = 0; x < part.cols; ++x)
      row[x] = is_small[static_cast<std::size_t>(label[x])] ? other : row[x];
  }
}

}  // namespace

std::optional<SegmentationMethod> ParseSegmentationMethod(std::string_view text) {
  if (text == "threshold") return SegmentationMethod::kThreshold;
  if (text == "adaptive") return SegmentationMethod::kAdaptive;
  return std::nullopt;
}

std::optional<ShadowRule> ParseShadowRule(std::string_view text) {
  if (text == "keep") return ShadowRule::kKeep;
  if (text == "reject") return ShadowRule::kReject;
  return std::nullopt;
}

std::string_view ToString(SegmentationMethod method) {
  return method == SegmentationMethod::kThreshold ? "threshold" : "adaptive";
}

std::string_view ToString(ShadowRule rule) { return rule == ShadowRule::kKeep ? "keep" : "reject"; }

void SegmentationOptions::Validate() const {
  // Written so that a NaN fails.
  RequireInRange(k_sigma > 0.0 && std::isfinite(k_sigma), "k_sigma", k_sigma, "a positive number");
  RequireInRange(floor_levels >= 0.0 && floor_levels <= 255.0, "floor_levels", floor_levels,
                 "in 0..255 grey levels");
  RequireInRange(edge_slack_px >= 0.0 && edge_slack_px <= 5.0, "edge_slack_px", edge_slack_px,
                 "in 0..5 pixels");
  RequireInRange(min_blob_px >= 0, "min_blob_px", min_blob_px, "at least 0 pixels");
  RequireInRange(max_hole_px >= 0, "max_hole_px", max_hole_px, "at least 0 pixels");
  RequireInRange(shadow_darkest >= 0.0 && shadow_darkest <= 1.0, "shadow_darkest", shadow_darkest, "in 0..1");
  RequireInRange(shadow_chroma >= 0.0 && shadow_chroma <= 1.0, "shadow_chroma", shadow_chroma, "in 0..1");
}

Segmenter::Segmenter(BackgroundReference background, const SegmentationOptions& options)
    : options_(options), mean_bgr_(std::move(background.mean_bgr)) {
  options.Validate();
  core::Require(mean_bgr_.type() == CV_32FC3 && !mean_bgr_.empty() &&
                    background.sigma_bgr.type() == CV_32FC3 &&
                    background.sigma_bgr.size() == mean_bgr_.size(),
                "a background reference has mean and sigma, CV_32FC3 of one size");
  background.mean_bgr = mean_bgr_;
  threshold_bgr_ = ThresholdOf(background, options);
  LevelsWithin(mean_bgr_, threshold_bgr_, lowest_bgr_, highest_bgr_);
}

core::BitMask Segmenter::Segment(const cv::Mat& image_bgr) const {
  core::Require(image_bgr.type() == CV_8UC3 && image_bgr.size() == mean_bgr_.size(),
                "a picture to segment is 8-bit BGR of its background's size");
  cv::Mat mean = mean_bgr_, lowest = lowest_bgr_, highest = highest_bgr_;
  if (options_.method == SegmentationMethod::kAdaptive) {
    mean = WithExposure(mean_bgr_, EstimateExposure(image_bgr, mean_bgr_));
    cv::Mat own_lowest, own_highest;
    LevelsWithin(mean, threshold_bgr_, own_lowest, own_highest);
    lowest = own_lowest, highest = own_highest;
  }
  cv::Mat object;
  cv::inRange(image_bgr, lowest, highest, object);
  cv::bitwise_not(object, object);
  if (options_.shadows == ShadowRule::kReject) {
    for (int y = 0; y < object.rows; ++y) {
      ClearShadowRow(image_bgr.ptr<std::uint8_t>(y), mean.ptr<float>(y),
                     static_cast<float>(options_.shadow_darkest), static_cast<float>(options_.shadow_chroma),
                     object.ptr<std::uint8_t>(y), object.cols);
    }
  }
  RemoveSmallRegions(object, kObject, options_.min_blob_px, 8);
  RemoveSmallRegions(object, 0, options_.max_hole_px, 4);
  return MaskFromImage(object);
}

}  // namespace elbowroom::recon
