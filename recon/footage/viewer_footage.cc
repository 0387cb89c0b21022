#include "recon/footage/viewer_footage.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "recon/footage/image_source.h"

namespace elbowroom::recon {

ViewerFootage::ViewerFootage(std::shared_ptr<RecordedRig> rig, core::CameraModel camera,
                             const std::string& location, std::stop_token stop)
    : rig_(std::move(rig)), location_(location) {
  core::Require(rig_ != nullptr, "a rig");
  std::shared_ptr<ImageSource> source = OpenImageSource(location, camera, std::move(stop));
  source_ = source;
  if (const std::optional<double> rate_hz = source_->frame_rate_hz())
    RequireOneRate({rig_->rig().cameras.front().name(), rig_->frame_rate_hz()}, {camera.name(), *rate_hz});
  promised_ = source_->frame_count();
  pictures_ = ReadAheadOf(std::move(source));
  camera_ = std::make_shared<const core::CameraModel>(std::move(camera));
}

std::optional<FrameSet> ViewerFootage::TryRead(core::FrameIndex index, std::stop_token stop) {
  const bool has_picture = index >= 0 && (!end_ || index < *end_);
  if (has_picture) pictures_->Expect(index);
  std::optional<FrameSet> set = rig_->TryRead(index, stop);
  if (!set || !has_picture) return set;
  if (auto picture = pictures_->Take(stop)) {
    set->viewer = ViewerPicture{camera_, std::move(picture->image_bgr)};
  } else {
    end_ = source_->frame_count();
  }
  return set;
}

std::vector<std::string> ViewerFootage::Warnings() const {
  std::vector<std::string> warnings = rig_->Warnings();
  if (end_ && *end_ < promised_) {
    warnings.push_back(
        fmt::format("the viewer's footage '{}' ended after {} frames of {} promised; later ones take their "
                    "colours from the rig's cameras",
                    location_, *end_, promised_));
  }
  return warnings;
}

std::vector<BackgroundReference> ViewerFootage::ReadBackgrounds(const core::Progress& progress,
                                                                std::stop_token stop) {
  return rig_->ReadBackgrounds(progress, std::move(stop));
}

}  // namespace elbowroom::recon
