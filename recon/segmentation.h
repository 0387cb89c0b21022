// Which pixels of a camera image are object: image subtraction with thresholds, against the empty scene.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string_view>

#include "core/bit_mask.h"
#include "recon/frame_set.h"

namespace elbowroom::recon {

enum class SegmentationMethod {
  kThreshold,  // against the background reference as it is
  kAdaptive,   // the reference first follows a change of exposure of the whole picture, gain and offset a channel
};
enum class ShadowRule { kKeep, kReject };

[[nodiscard]] std::optional<SegmentationMethod> ParseSegmentationMethod(std::string_view text);
[[nodiscard]] std::optional<ShadowRule> ParseShadowRule(std::string_view text);  // "keep", "reject"
[[nodiscard]] std::string_view ToString(SegmentationMethod method);
[[nodiscard]] std::string_view ToString(ShadowRule rule);

struct SegmentationOptions {
  SegmentationMethod method = SegmentationMethod::kThreshold;
  double k_sigma = 5.0;        // > 0; times the pixel's own noise
  double floor_levels = 15.0;  // 0..255 grey levels; the least difference that counts, whatever the noise
  int min_blob_px = 100;       // >= 0; smaller 8-connected object regions are removed
  int max_hole_px = 20;        // >= 0; smaller 4-connected background regions inside an object are filled
  ShadowRule shadows = ShadowRule::kReject;
  double shadow_darkest = 0.55;  // 0..1; below this share of the background's brightness it is no shadow
  double shadow_chroma = 0.05;   // 0..1; how far, as a share of the brightness, a shadow may change its colour

  // Throws: Error{kRange} naming the option that is out of range.
  void Validate() const;
};

// Object where |I - mean| > max(k_sigma * sigma, floor_levels) in any channel (the paper's image subtraction with
// thresholds, in units of each pixel's noise), less shadows: darker than the background in the same colour.
// A picture without any difference gives an empty mask. Deterministic, whatever the number of threads.
// Throws: PreconditionError unless `image_bgr` is CV_8UC3 of the background's size.
[[nodiscard]] core::BitMask Segment(const cv::Mat& image_bgr, const BackgroundReference& background,
                                    const SegmentationOptions& options);

}  // namespace elbowroom::recon
