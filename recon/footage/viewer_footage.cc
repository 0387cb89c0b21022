#include "recon/footage/viewer_footage.h"

#include <utility>

#include "core/error.h"
#include "recon/footage/image_source.h"

namespace elbowroom::recon {

ViewerFootage::ViewerFootage(std::shared_ptr<RecordedRig> rig, core::CameraModel camera,
                             const std::string& location, std::stop_token stop)
    : rig_(std::move(rig)) {
  core::Require(rig_ != nullptr, "a rig");
  source_ = OpenImageSource(location, camera, std::move(stop));
  if (const std::optional<double> rate_hz = source_->frame_rate_hz())
    RequireOneRate({rig_->rig().cameras.front().name(), rig_->frame_rate_hz()}, {camera.name(), *rate_hz});
  frames_ = source_->frame_count();
  pictures_ = std::make_unique<ReadAhead>(
      [source = source_](core::FrameIndex index, const std::stop_token& reading) {
        SourcePicture picture = source->Read(index, reading);
        return CameraFrame{std::move(picture.image_bgr), std::nullopt, picture.captured_at};
      },
      frames_);
  camera_ = std::make_shared<const core::CameraModel>(std::move(camera));
}

FrameSet ViewerFootage::Read(core::FrameIndex index, std::stop_token stop) {
  const bool has_picture = index >= 0 && (!frames_ || index < *frames_);
  if (has_picture) pictures_->Expect(index);
  FrameSet set = rig_->Read(index, stop);
  if (has_picture) set.viewer = ViewerPicture{camera_, pictures_->Take(stop).frame.image_bgr};
  return set;
}

std::vector<std::string> ViewerFootage::Warnings() const {
  std::vector<std::string> warnings = rig_->Warnings();
  AddWarningOf(*source_, camera_->name(), &warnings);
  return warnings;
}

std::vector<BackgroundReference> ViewerFootage::ReadBackgrounds(const core::Progress& progress,
                                                                std::stop_token stop) {
  return rig_->ReadBackgrounds(progress, std::move(stop));
}

}  // namespace elbowroom::recon
