// How pictures are segmented, and what differs for single cameras.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bit_mask.h"
#include "core/rig.h"

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

// What differs for one camera of a rig.
struct CameraSegmentation {
  std::string camera;                  // its name in the rig
  std::optional<double> k_sigma;       // as in SegmentationOptions, or nothing
  std::optional<double> floor_levels;  // likewise
  core::BitMask ignore;                // pixels that are always background; no size: none

  // Throws: Error{kRange} naming the camera: it isn't in the rig, its mask isn't of its size, or a number is
  // out of range.
  void Validate(const core::Rig& rig) const;
};

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

  std::vector<CameraSegmentation> cameras;  // at most one a camera

  // Throws: Error{kRange} naming the option that is out of range.
  void Validate() const;

  // Validate() of these options and of each camera's. Throws: likewise; Error{kRange} for a camera that is
  // named twice.
  void Validate(const core::Rig& rig) const;

  // What holds for a camera; null: nothing that differs.
  [[nodiscard]] const CameraSegmentation* OfCamera(std::string_view camera) const;
  // The options with what differs for a camera put in.
  [[nodiscard]] SegmentationOptions ForCamera(std::string_view camera) const;
};

}  // namespace elbowroom::recon
