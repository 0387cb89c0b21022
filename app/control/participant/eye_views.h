// What the participant's eyes see: from the head's pose to pinhole views.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/appearance/scene_view.h"
#include "recon/head_pose/head_pose.h"

namespace elbowroom::control {

enum class ViewMode {
  kMono,    // one picture, from between the eyes
  kStereo,  // the left eye's picture beside the right eye's
  kMirror,  // mono with left and right exchanged, as in a mirror, or for a picture thrown on from behind
  kCamera,  // a rig camera's live picture with the virtual parts in it; the head has no part in it
  kCameraMirror,  // the same as in a mirror
  kHeadCamera,    // the picture of a camera on the head, with the virtual parts in it
};
// "mono", "stereo", "mirror", "camera", "camera_mirror", "head_camera".
[[nodiscard]] std::optional<ViewMode> ParseViewMode(std::string_view text);
[[nodiscard]] std::string_view ToString(ViewMode mode);
[[nodiscard]] constexpr bool IsOfCamera(ViewMode mode) {
  return mode == ViewMode::kCamera || mode == ViewMode::kCameraMirror || mode == ViewMode::kHeadCamera;
}
[[nodiscard]] constexpr bool NeedsHead(ViewMode mode) {
  return !IsOfCamera(mode) || mode == ViewMode::kHeadCamera;
}

struct EyeOptions {
  ViewMode mode = ViewMode::kMono;
  double ipd_mm = 63.0;            // between the pupils, [0, 100]
  double vertical_fov_rad = 1.05;  // of a picture, [0.2, 2.4]
  double convergence_mm = 700.0;   // where a point straight ahead is in the middle of both pictures, >= 100

  // Throws: PreconditionError naming the option out of range.
  void Validate() const;
  [[nodiscard]] bool operator==(const EyeOptions&) const = default;
};

// One eye's picture: a part of a picture of `view`, which is symmetric about its axis. What is left out makes
// the frustum an off-axis one (docs/head_pose.md).
struct EyeView {
  recon::SceneView view;
  int first_column = 0;
  int first_row = 0;
  int width_px = 0;
  int height_px = 0;

  // What is in that part.
  [[nodiscard]] recon::EyeTangents Seen() const;
};

// For a picture of width_px x height_px: one view, or the left eye's, then the right eye's, each half as
// wide. Throws: PreconditionError: EyeOptions::Validate, a picture smaller than 64 x 64, one of a camera.
[[nodiscard]] std::vector<EyeView> EyeViewsOf(const core::RigidTransform& world_from_head,
                                              const EyeOptions& options, int width_px, int height_px);

// The eyes of a headset, left and right: square pixels, each picture at most so large, what it shows that
// which the headset asks for but for a pixel at a side, as Seen() says exactly. Throws: PreconditionError:
// less than 64 x 64 pixels.
[[nodiscard]] std::vector<EyeView> HeadsetEyeViewsOf(const core::RigidTransform& world_from_head,
                                                     const recon::HeadsetEyes& eyes, int eye_width_px,
                                                     int eye_height_px);

}  // namespace elbowroom::control
