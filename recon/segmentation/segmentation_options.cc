#include "recon/segmentation/segmentation_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

void RequireInRange(bool holds, std::string_view option, double value, std::string_view range) {
  if (holds) return;
  throw core::Error(core::ErrorKind::kRange,
                    fmt::format("segmentation: {} is {}, but must be {}", option, value, range));
}

[[noreturn]] void FailCamera(const std::string& camera, const std::string& what) {
  throw core::Error(core::ErrorKind::kRange, fmt::format("segmentation: camera '{}' {}", camera, what));
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

void CameraSegmentation::Validate(const core::Rig& rig) const {
  const auto in_rig = std::ranges::find(rig.cameras, camera, &core::CameraModel::name);
  if (in_rig == rig.cameras.end()) {
    std::string names;
    for (const core::CameraModel& other : rig.cameras)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", other.name());
    FailCamera(camera, fmt::format("isn't in the rig, whose cameras are {}", names));
  }
  const bool has_mask = ignore.width_px() != 0;
  if (has_mask && (ignore.width_px() != in_rig->width_px() || ignore.height_px() != in_rig->height_px())) {
    FailCamera(camera,
               fmt::format("has an ignore mask of {} x {} pixels, but its pictures have {} x {}",
                           ignore.width_px(), ignore.height_px(), in_rig->width_px(), in_rig->height_px()));
  }
  SegmentationOptions options;
  options.k_sigma = k_sigma.value_or(options.k_sigma);
  options.floor_levels = floor_levels.value_or(options.floor_levels);
  try {
    options.Validate();
  } catch (const core::Error& error) {
    throw core::Error(error.kind(), fmt::format("camera '{}': {}", camera, error.what()));
  }
}

void SegmentationOptions::Validate(const core::Rig& rig) const {
  Validate();
  for (const CameraSegmentation& camera : cameras) {
    camera.Validate(rig);
    if (std::ranges::count(cameras, camera.camera, &CameraSegmentation::camera) > 1)
      FailCamera(camera.camera, "is named twice");
  }
}

const CameraSegmentation* SegmentationOptions::OfCamera(std::string_view camera) const {
  const auto found = std::ranges::find(cameras, camera, &CameraSegmentation::camera);
  return found == cameras.end() ? nullptr : &*found;
}

SegmentationOptions SegmentationOptions::ForCamera(std::string_view camera) const {
  SegmentationOptions options = *this;
  options.cameras.clear();
  if (const CameraSegmentation* differing = OfCamera(camera)) {
    options.k_sigma = differing->k_sigma.value_or(k_sigma);
    options.floor_levels = differing->floor_levels.value_or(floor_levels);
  }
  return options;
}

}  // namespace elbowroom::recon
