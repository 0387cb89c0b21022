#include "app/control/tiles/frame_overlays.h"

#include "app/control/palette/part_colors.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

std::vector<OverlayPart> PartsOf(const FrameResult& result, OutlinedMeshes* meshes) {
  std::vector<OverlayPart> parts;
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i) {
    OverlayPart part;
    if (const core::SharedMesh hanging = result.response ? result.response->meshes_in_world[i] : nullptr) {
      part.mesh = meshes->Of(hanging);
    } else {
      part.mesh = meshes->Of(result.layout->parts[i].mesh);
      part.world_from_part = result.world_from_parts[i];
    }
    const core::Verdict verdict = result.record.contacts[i].verdict;
    part.color = verdict == core::Verdict::kContact ? BandColor(verdict) : PlainPartColor(i);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

void FrameOverlays::PaintOn(recon::Image* picture, const FrameResult& result, core::CameraIndex camera) {
  if (picture->rgb.empty() || result.hull == nullptr || result.layout == nullptr) return;
  if (rig_ != result.hull->shared_rig()) {
    rig_ = result.hull->shared_rig();
    overlays_.clear();
    overlays_.resize(rig_->cameras.size());
  }
  std::unique_ptr<CameraOverlay>& overlay = overlays_[camera];
  if (!overlay || overlay->layer().width_px != picture->width_px ||
      overlay->layer().height_px != picture->height_px) {
    overlay =
        std::make_unique<CameraOverlay>(rig_->cameras[camera], picture->width_px, picture->height_px, look_);
  }
  overlay->Place(PartsOf(result, &meshes_));
  overlay->PaintOn(picture, result.hull);
}

void FrameOverlays::PaintOn(recon::Image* picture, const FrameResult& result,
                            const core::CameraModel& camera) {
  if (picture->rgb.empty() || result.layout == nullptr) return;
  const auto is_there = [&](const core::CameraModel& other) {
    return other.cam_from_world() == camera.cam_from_world() && other.width_px() == picture->width_px &&
           other.height_px() == picture->height_px &&
           other.calibration().camera_matrix == camera.calibration().camera_matrix;
  };
  if (!moving_ || !is_there(moving_->view().camera()))
    moving_ = std::make_unique<CameraOverlay>(camera, picture->width_px, picture->height_px, look_);
  moving_->Place(PartsOf(result, &meshes_));
  moving_->PaintOn(picture, result.hull);
}

OverlayCount FrameOverlays::count() const {
  OverlayCount sum;
  for (const auto& overlay : overlays_)
    if (overlay) sum += overlay->count();
  return sum;
}

}  // namespace elbowroom::control
