// Virtual parts in one camera's live picture, hidden by what is real before them (docs/camera_overlay.md).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/control/overlay/outlined_mesh.h"
#include "app/control/overlay/overlay_layer.h"
#include "app/control/overlay/view_pixels.h"
#include "core/rigid_transform.h"
#include "recon/exact_view/hull_view.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/images/image.h"

namespace elbowroom::control {

struct OverlayPart {
  std::shared_ptr<const OutlinedMesh> mesh;
  core::RigidTransform world_from_part;
  Eigen::Vector3f color = {0.62F, 0.67F, 0.73F};  // red, green, blue, 0 to 1
};

struct OverlayLook {
  double line_width_px = 1.5;  // (0, 16]
  double face_opacity = 0.45;  // [0, 1]; 0: lines only
};

// What was drawn, and what wasn't because it couldn't have changed.
struct OverlayCount {
  std::int64_t parts_drawn = 0;
  std::int64_t parts_kept = 0;
  std::int64_t layers_composed = 0;
  std::int64_t layers_kept = 0;
  std::int64_t hulls_viewed = 0;
  std::int64_t hulls_kept = 0;     // neither hull nor size has changed
  std::int64_t hulls_unasked = 0;  // no part is in the picture

  OverlayCount& operator+=(const OverlayCount& other);
};

// Thread: one at a time.
class CameraOverlay {
 public:
  // Of pictures of this size, with the camera's lens. Throws: PreconditionError for a look out of range.
  CameraOverlay(const core::CameraModel& camera, int width_px, int height_px, const OverlayLook& look = {});

  // Where the parts are now. A part whose mesh and place are those of before isn't drawn again; if none is,
  // the whole layer stays. Colours may change at any time.
  void Place(std::span<const OverlayPart> parts);

  // Draws the parts on a picture of the camera. Where the hull's first surface is nearer than the part, the
  // picture stays. Null: nothing real. Throws: PreconditionError for a picture of another size.
  void PaintOn(recon::Image* picture, const std::shared_ptr<const recon::VisualHull>& hull);

  [[nodiscard]] const ViewPixels& view() const { return view_; }
  [[nodiscard]] const OverlayLayer& layer() const { return layer_; }
  [[nodiscard]] const OverlayCount& count() const { return count_; }  // since it was made
  // Of the last hull, one a pixel; 0: it isn't there, or was never asked.
  [[nodiscard]] const recon::PictureBuffer<float>& hull_depth_mm() const { return hull_view_.depth_mm; }

 private:
  void ViewHull(const std::shared_ptr<const recon::VisualHull>& hull);

  OverlayLook look_;
  ViewPixels view_;
  std::vector<std::shared_ptr<const PartPicture>> pictures_;
  std::vector<Eigen::Vector3f> colors_;
  OverlayLayer layer_;
  std::shared_ptr<const recon::VisualHull> hull_;  // that hull_view_ shows
  recon::HullView hull_view_;
  OverlayCount count_;
};

}  // namespace elbowroom::control
