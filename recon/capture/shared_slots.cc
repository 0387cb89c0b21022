#include "recon/capture/shared_slots.h"

#include "core/error.h"
#include "recon/capture/device/camera_protocol.h"

namespace elbowroom::recon {

SharedSlots::SharedSlots(cv::Size size_px)
    : bytes_(std::size_t{3} * static_cast<std::size_t>(size_px.area())),
      size_px_(size_px),
      memory_("camera", bytes_ * kPictureSlots) {}

cv::Mat SharedSlots::Slot(std::int32_t slot) const {
  core::Require(slot >= 0 && slot < kPictureSlots, "a slot is one of those that there are");
  return {size_px_, CV_8UC3, memory_.bytes().data() + static_cast<std::size_t>(slot) * bytes_};
}

}  // namespace elbowroom::recon
