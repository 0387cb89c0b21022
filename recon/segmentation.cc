#include "recon/segmentation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

// 255 where any channel differs by more than its threshold.
void MarkDifferentRow(const std::uint8_t* image, const float* mean, const float* sigma, float k_sigma, float floor,
                      std::uint8_t* object, int width) {
  for (int x = 0; x < width; ++x) {
    bool different = false;
    for (int c = 0; c < 3; ++c) {
      const int i = 3 * x + c;
      const float threshold = std::max(k_sigma * sigma[i], floor);
      different |= std::abs(static_cast<float>(image[i]) - mean[i]) > threshold;
    }
    object[x] = different ? kObject : 0;
  }
}

// Clears the pixels that are the background in shade. With I the pixel, B the background's mean and
// g = I.B / B.B the share of its brightness that is left, it is shade where darkest <= g < 1 and the rest
// I - g B, which is change of colour, is short beside B.
void ClearShadowRow(const std::uint8_t* image, const float* mean, float darkest, float chroma, std::uint8_t* object,
                    int width) {
  for (int x = 0; x < width; ++x) {
    float ib = 0.0F, bb = 0.0F, ii = 0.0F;
    for (int c = 0; c < 3; ++c) {
      const float i = static_cast<float>(image[3 * x + c]);
      const float b = mean[3 * x + c];
      ib += i * b, bb += b * b, ii += i * i;
    }
    // |I - g B|^2 = I.I - (I.B)^2 / B.B; all sides times B.B.
    const bool is_shade = ib >= darkest * bb && ib < bb && ii * bb - ib * ib < chroma * chroma * bb * bb;
    object[x] = is_shade ? 0 : object[x];
  }
}

// Regions of `value` smaller than `least_px` take the other value.
void RemoveSmallRegions(cv::Mat& object, std::uint8_t value, int least_px, int connectivity) {
  if (least_px <= 1) return;
  cv::Mat labels, stats, centroids;
  const cv::Mat region = value == kObject ? object : cv::Mat(object == 0);
  const int count = cv::connectedComponentsWithStats(region, labels, stats, centroids, connectivity, CV_32S);
  std::vector<std::uint8_t> is_small(static_cast<std::size_t>(count), 0);
  for (int i = 1; i < count; ++i) {
    is_small[static_cast<std::size_t>(i)] = stats.at<int>(i, cv::CC_STAT_AREA) < least_px ? 1 : 0;
  }
  const std::uint8_t other = value == kObject ? 0 : kObject;
  for (int y = 0; y < object.rows; ++y) {
    const int* label = labels.ptr<int>(y);
    auto* row = object.ptr<std::uint8_t>(y);
    for (int x = 0; x < object.cols; ++x) row[x] = is_small[static_cast<std::size_t>(label[x])] ? other : row[x];
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
  RequireInRange(floor_levels >= 0.0 && floor_levels <= 255.0, "floor_levels", floor_levels, "in 0..255 grey levels");
  RequireInRange(min_blob_px >= 0, "min_blob_px", min_blob_px, "at least 0 pixels");
  RequireInRange(max_hole_px >= 0, "max_hole_px", max_hole_px, "at least 0 pixels");
  RequireInRange(shadow_darkest >= 0.0 && shadow_darkest <= 1.0, "shadow_darkest", shadow_darkest, "in 0..1");
  RequireInRange(shadow_chroma >= 0.0 && shadow_chroma <= 1.0, "shadow_chroma", shadow_chroma, "in 0..1");
}

core::BitMask Segment(const cv::Mat& image_bgr, const BackgroundReference& background,
                      const SegmentationOptions& options) {
  options.Validate();
  core::Require(image_bgr.type() == CV_8UC3 && image_bgr.size() == background.mean_bgr.size(),
                "a picture to segment is 8-bit BGR of its background's size");
  const cv::Mat mean_bgr = options.method == SegmentationMethod::kAdaptive
                               ? WithExposure(background.mean_bgr, EstimateExposure(image_bgr, background.mean_bgr))
                               : background.mean_bgr;
  const auto k_sigma = static_cast<float>(options.k_sigma);
  const auto floor_levels = static_cast<float>(options.floor_levels);
  cv::Mat object(image_bgr.size(), CV_8U);
  for (int y = 0; y < object.rows; ++y) {
    const auto* image = image_bgr.ptr<std::uint8_t>(y);
    const auto* mean = mean_bgr.ptr<float>(y);
    auto* row = object.ptr<std::uint8_t>(y);
    MarkDifferentRow(image, mean, background.sigma_bgr.ptr<float>(y), k_sigma, floor_levels, row, object.cols);
    if (options.shadows == ShadowRule::kReject) {
      ClearShadowRow(image, mean, static_cast<float>(options.shadow_darkest),
                     static_cast<float>(options.shadow_chroma), row, object.cols);
    }
  }
  RemoveSmallRegions(object, kObject, options.min_blob_px, 8);
  RemoveSmallRegions(object, 0, options.max_hole_px, 4);
  return MaskFromImage(object);
}

}  // namespace elbowroom::recon
