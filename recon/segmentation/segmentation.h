// Which pixels of a camera image are object: image subtraction with thresholds, against the empty scene.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string_view>

#include "core/bit_mask.h"
#include "core/soft_mask.h"
#include "recon/footage/frame_set.h"
#include "recon/segmentation/exposure_estimator.h"
#include "recon/segmentation/followed_ranges.h"
#include "recon/segmentation/level_ranges.h"

namespace elbowroom::recon {

enum class SegmentationMethod {
  kThreshold,  // against the background reference as it is
  kAdaptive,   // the reference first follows a change of exposure of the whole picture, gain and offset a
               // channel
};
enum class ShadowRule { kKeep, kReject };

[[nodiscard]] std::optional<SegmentationMethod> ParseSegmentationMethod(std::string_view text);
[[nodiscard]] std::optional<ShadowRule> ParseShadowRule(std::string_view text);  // "keep", "reject"
[[nodiscard]] std::string_view ToString(SegmentationMethod method);
[[nodiscard]] std::string_view ToString(ShadowRule rule);

struct SegmentationOptions {
  SegmentationMethod method = SegmentationMethod::kThreshold;
  double k_sigma = 5.0;        // > 0; times the pixel's own noise
  double floor_levels = 20.0;  // 0..255 grey levels; the least difference that counts, whatever the noise
  double edge_slack_px = 0.8;  // 0..5; how far a camera may have shifted since the background was taken
  int min_blob_px = 200;       // >= 0; smaller 8-connected object regions are removed
  int max_hole_px = 100;       // >= 0; smaller 4-connected background regions inside an object are filled
  ShadowRule shadows = ShadowRule::kReject;
  double shadow_darkest = 0.55;  // 0..1; below this share of the background's brightness it is no shadow
  double shadow_chroma = 0.10;   // 0..1; how far a shadow may change its colour, as a share of its brightness

  // Throws: Error{kRange} naming the option that is out of range.
  void Validate() const;
};

struct SegmentationStats {
  std::int64_t pixels = 0;          // of the pictures segmented
  std::int64_t skipped_pixels = 0;  // of those: not looked at, as no region of min_blob_px can be there

  // Adds the counts of other pictures.
  SegmentationStats& operator+=(const SegmentationStats& other);
};

// One camera's background with its thresholds worked out. Immutable.
//
// Object where |I - mean| > max(k_sigma * sigma, floor_levels) + edge_slack_px * |gradient of mean| in any
// channel: the paper's image subtraction with thresholds, in units of each pixel's noise. Shadows are left
// out: pixels darker than the background in the same colour. Then small regions are removed and small holes
// filled. A picture without any difference gives an empty mask. The same result for any number of threads.
class Segmenter {
 public:
  // Throws: Error{kRange} as Validate(); PreconditionError for an empty background.
  Segmenter(BackgroundReference background, const SegmentationOptions& options);

  // The pixels detected as above; `stats` receives the counts. Throws: PreconditionError unless `image_bgr`
  // is CV_8UC3 of the background's size.
  [[nodiscard]] core::BitMask Segment(const cv::Mat& image_bgr, SegmentationStats* stats = nullptr) const;

  // The same with its boundary located between pixels, as LocateBoundary. Throws: likewise.
  [[nodiscard]] core::SoftMask SegmentSoft(const cv::Mat& image_bgr,
                                           SegmentationStats* stats = nullptr) const;

 private:
  // The change that a picture is compared under; nothing for kThreshold. Throws: as Segment().
  [[nodiscard]] std::optional<FixedExposure> ExposureOf(const cv::Mat& image_bgr) const;
  [[nodiscard]] core::BitMask Detect(const cv::Mat& image_bgr, const std::optional<FixedExposure>& exposure,
                                     SegmentationStats* stats) const;

  SegmentationOptions options_;
  cv::Size size_;
  cv::Mat packed_mean_;
  LevelRanges ranges_;  // for kThreshold; the next two are for kAdaptive
  FollowedRanges followed_ranges_;
  ExposureEstimator exposure_estimator_;
};

}  // namespace elbowroom::recon
