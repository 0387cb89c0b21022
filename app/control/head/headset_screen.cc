#include "app/control/head/headset_screen.h"

namespace elbowroom::control {

void HeadsetScreen::Attach(recon::HeadsetLink* link) {
  const std::lock_guard lock(mutex_);
  link_ = link;
}

bool HeadsetScreen::Show(std::int64_t pose, const std::array<recon::EyePicture, 2>& eyes) {
  const std::lock_guard lock(mutex_);
  return link_ != nullptr && link_->Show(pose, eyes);
}

void HeadsetScreen::SetRecommended(const std::array<int, 2>& size_px) {
  const std::lock_guard lock(mutex_);
  recommended_px_ = size_px;
}

std::array<int, 2> HeadsetScreen::recommended_px() const {
  const std::lock_guard lock(mutex_);
  return recommended_px_;
}

}  // namespace elbowroom::control
