// The layout's parts in the pictures of a frame's cameras.
#pragma once

#include <memory>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/overlay/camera_overlay.h"
#include "core/ids.h"
#include "recon/images/image.h"

namespace elbowroom::control {

// Keeps for each camera what it drew of the last frame. Parts have the operator's view's colours; those in
// contact are orange-red. Streams aren't drawn. Thread: one at a time.
class FrameOverlays {
 public:
  explicit FrameOverlays(const OverlayLook& look = {}) : look_(look) {}

  // Draws the frame's parts on a picture of one of its cameras, which may have any size. An empty picture
  // stays so.
  void PaintOn(recon::Image* picture, const FrameResult& result, core::CameraIndex camera);

  // The same on a picture of a camera that isn't one of the rig's, and may move.
  void PaintOn(recon::Image* picture, const FrameResult& result, const core::CameraModel& camera);

  [[nodiscard]] OverlayCount count() const;  // of the cameras' present sizes

 private:
  OverlayLook look_;
  OutlinedMeshes meshes_;
  std::shared_ptr<const core::Rig> rig_;
  std::vector<std::unique_ptr<CameraOverlay>> overlays_;  // one a camera; null: not asked for yet
  std::unique_ptr<CameraOverlay> moving_;                 // of the camera that isn't the rig's
};

}  // namespace elbowroom::control
