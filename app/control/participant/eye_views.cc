#include "app/control/participant/eye_views.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::control {
namespace {

constexpr double kNearMm = 40.0, kFarMm = 20'000.0;
constexpr int kSmallestPx = 64;
constexpr ViewMode kModes[] = {ViewMode::kMono,   ViewMode::kStereo,       ViewMode::kMirror,
                               ViewMode::kCamera, ViewMode::kCameraMirror, ViewMode::kHeadCamera};

// The view from a point of the head's x axis, its axes the head's.
recon::SceneView ViewFromEye(const core::RigidTransform& world_from_head, double eye_x_mm,
                             const EyeOptions& options, int width_px, int height_px) {
  const core::RigidTransform head_from_eye{Eigen::Matrix3d::Identity(), {eye_x_mm, 0.0, 0.0}};
  recon::SceneView view;
  view.cam_from_world = (world_from_head * head_from_eye).Inverse();
  view.width_px = width_px;
  view.height_px = height_px;
  view.focal_px = 0.5 * height_px / std::tan(0.5 * options.vertical_fov_rad);
  view.near_mm = kNearMm;
  view.far_mm = kFarMm;
  return view;
}

// A part of a picture that is symmetric about its axis.
struct Span {
  int first_px = 0;
  int size_px = 0;
  int whole_px = 0;
};

// From `low` to `high`, in pixels from the axis, both to the next whole pixel.
Span SpanOf(double low_px, double high_px, int most_px) {
  const int low = static_cast<int>(std::lround(low_px));
  const int high = std::max(low + 1, std::min(static_cast<int>(std::lround(high_px)), low + most_px));
  const int half = std::max({-low, high, 1});
  return {half + low, high - low, 2 * half};
}

}  // namespace

std::optional<ViewMode> ParseViewMode(std::string_view text) {
  for (const ViewMode mode : kModes)
    if (text == ToString(mode)) return mode;
  return std::nullopt;
}

std::string_view ToString(ViewMode mode) {
  switch (mode) {
    case ViewMode::kMono:
      return "mono";
    case ViewMode::kStereo:
      return "stereo";
    case ViewMode::kMirror:
      return "mirror";
    case ViewMode::kCamera:
      return "camera";
    case ViewMode::kCameraMirror:
      return "camera_mirror";
    case ViewMode::kHeadCamera:
      return "head_camera";
  }
  return "";
}

void EyeOptions::Validate() const {
  core::Require(ipd_mm >= 0.0 && ipd_mm <= 100.0, "ipd_mm lies within [0, 100]");
  core::Require(vertical_fov_rad >= 0.2 && vertical_fov_rad <= 2.4,
                "vertical_fov_rad lies within [0.2, 2.4]");
  core::Require(convergence_mm >= 100.0, "convergence_mm is 100 at least");
}

std::vector<EyeView> EyeViewsOf(const core::RigidTransform& world_from_head, const EyeOptions& options,
                                int width_px, int height_px) {
  options.Validate();
  core::Require(!IsOfCamera(options.mode), "the picture is one of the head's");
  core::Require(width_px >= kSmallestPx && height_px >= kSmallestPx, "a picture has 64 x 64 pixels");
  if (options.mode != ViewMode::kStereo)
    return {{ViewFromEye(world_from_head, 0.0, options, width_px, height_px), 0, 0, width_px, height_px}};
  const int eye_width_px = width_px / 2;
  const double focal_px = 0.5 * height_px / std::tan(0.5 * options.vertical_fov_rad);
  // The point straight ahead at convergence_mm is focal_px * (ipd / 2) / convergence from each eye's axis. A
  // picture that is wider by twice that, cut off on one side, has it in its middle.
  const int cut_px = static_cast<int>(std::lround(focal_px * options.ipd_mm / options.convergence_mm));
  const double half_mm = 0.5 * options.ipd_mm;
  const int whole_px = eye_width_px + cut_px;
  return {
      {ViewFromEye(world_from_head, -half_mm, options, whole_px, height_px), cut_px, 0, eye_width_px,
       height_px},
      {ViewFromEye(world_from_head, half_mm, options, whole_px, height_px), 0, 0, eye_width_px, height_px}};
}

std::vector<EyeView> HeadsetEyeViewsOf(const core::RigidTransform& world_from_head,
                                       const recon::HeadsetEyes& eyes, int eye_width_px, int eye_height_px) {
  core::Require(eye_width_px >= kSmallestPx && eye_height_px >= kSmallestPx, "a picture has 64 x 64 pixels");
  std::vector<EyeView> views;
  for (const recon::HeadsetEyes::Eye& eye : eyes.eyes) {
    const recon::EyeTangents& wanted = eye.tangents;
    const double focal_px =
        std::min(eye_width_px / (wanted.right - wanted.left), eye_height_px / (wanted.up - wanted.down));
    const Span columns = SpanOf(focal_px * wanted.left, focal_px * wanted.right, eye_width_px);
    const Span rows = SpanOf(-focal_px * wanted.up, -focal_px * wanted.down, eye_height_px);
    EyeView view;
    view.view.cam_from_world = (world_from_head * eye.head_from_eye).Inverse();
    view.view.focal_px = focal_px;
    view.view.near_mm = kNearMm;
    view.view.far_mm = kFarMm;
    view.view.width_px = columns.whole_px;
    view.view.height_px = rows.whole_px;
    view.first_column = columns.first_px;
    view.first_row = rows.first_px;
    view.width_px = columns.size_px;
    view.height_px = rows.size_px;
    views.push_back(view);
  }
  return views;
}

recon::EyeTangents EyeView::Seen() const {
  const double left = (first_column - 0.5 * view.width_px) / view.focal_px;
  const double up = (0.5 * view.height_px - first_row) / view.focal_px;
  return {left, left + width_px / view.focal_px, up, up - height_px / view.focal_px};
}

}  // namespace elbowroom::control
