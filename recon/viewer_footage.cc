#include "recon/viewer_footage.h"

#include <utility>

#include "core/error.h"
#include "recon/image_source.h"

namespace elbowroom::recon {

ViewerFootage::ViewerFootage(std::shared_ptr<RecordedRig> rig, core::CameraModel camera,
                             const std::string& location, std::stop_token stop)
    : rig_(std::move(rig)) {
  core::Require(rig_ != nullptr, "a rig");
  const std::shared_ptr<ImageSource> source = OpenImageSource(location, camera, std::move(stop));
  if (const std::optional<double> rate_hz = source->frame_rate_hz())
    RequireOneRate({rig_->rig().cameras.front().name(), rig_->frame_rate_hz()}, {camera.name(), *rate_hz});
  frames_ = source->frame_count();
  pictures_ = std::make_unique<ReadAhead>(
      [source](core::FrameIndex index) {
        return CameraFrame{source->Read(index), std::nullopt};
      },
      frames_);
  camera_ = std::make_shared<const core::CameraModel>(std::move(camera));
}

FrameSet ViewerFootage::Read(core::FrameIndex index) {
  const bool has_picture = index >= 0 && (!frames_ || index < *frames_);
  if (has_picture) pictures_->Expect(index);
  FrameSet set = rig_->Read(index);
  if (has_picture) set.viewer = ViewerPicture{camera_, pictures_->Take().frame.image_bgr};
  return set;
}

std::vector<BackgroundReference> ViewerFootage::ReadBackgrounds(const core::Progress& progress,
                                                                std::stop_token stop) {
  return rig_->ReadBackgrounds(progress, std::move(stop));
}

}  // namespace elbowroom::recon
