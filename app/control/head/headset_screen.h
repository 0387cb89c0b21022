// Where pictures for a headset go, whether one is there or not.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>

#include "recon/headset/headset_link.h"

namespace elbowroom::control {

// Shared by the tracker, which comes and goes with its headset, and by the thread that draws. Thread: any.
class HeadsetScreen {
 public:
  // Null: there is no headset. The link must live until another one, or null, takes its place.
  void Attach(recon::HeadsetLink* link);

  // False: there is no headset, or it hasn't taken the last pictures yet.
  bool Show(std::int64_t pose, const std::array<recon::EyePicture, 2>& eyes);

  // Width and height of the picture that the headset wants for an eye; 0: not known yet.
  void SetRecommended(const std::array<int, 2>& size_px);
  [[nodiscard]] std::array<int, 2> recommended_px() const;

 private:
  mutable std::mutex mutex_;
  recon::HeadsetLink* link_ = nullptr;
  std::array<int, 2> recommended_px_{};
};

}  // namespace elbowroom::control
