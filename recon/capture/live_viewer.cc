#include "recon/capture/live_viewer.h"

#include <fmt/format.h>

#include <utility>

namespace elbowroom::recon {

LiveViewer::LiveViewer(std::shared_ptr<FrameSetSource> rig, core::CameraModel camera,
                       const std::string& location)
    : rig_(std::move(rig)), camera_(std::make_shared<const core::CameraModel>(std::move(camera))) {
  CaptureHandlers handlers;
  handlers.on_picture = [this](CapturedPicture picture) {
    const std::lock_guard lock(mutex_);
    latest_ = std::move(picture);
  };
  handlers.on_loss = [](core::PictureLoss) {};  // a colour that is a frame old is no loss
  handlers.on_state = [this](const CameraState& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
    if (state.presence == CameraPresence::kGone) latest_.reset();
  };
  link_ = std::make_unique<CameraLink>(DeviceRequest{location, camera_->width_px(), camera_->height_px(), {}},
                                       std::move(handlers));
}

std::optional<FrameSet> LiveViewer::TryRead(core::FrameIndex index, std::stop_token stop) {
  std::optional<FrameSet> set = rig_->TryRead(index, std::move(stop));
  const std::lock_guard lock(mutex_);
  if (set && latest_) set->viewer = ViewerPicture{camera_, latest_->image_bgr};
  return set;
}

std::vector<std::string> LiveViewer::Warnings() const {
  std::vector<std::string> warnings = rig_->Warnings();
  const std::lock_guard lock(mutex_);
  if (!state_.trouble.empty())
    warnings.push_back(fmt::format("viewer camera '{}': {}", camera_->name(), state_.trouble));
  return warnings;
}

std::vector<BackgroundReference> LiveViewer::ReadBackgrounds(const core::Progress& progress,
                                                             std::stop_token stop) {
  return rig_->ReadBackgrounds(progress, std::move(stop));
}

}  // namespace elbowroom::recon
