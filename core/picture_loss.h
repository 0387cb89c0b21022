// Pictures of live cameras that no frame has, and why.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/ids.h"

namespace elbowroom::core {

// Why a picture that a live camera counted isn't in any frame.
enum class LossReason {
  kNotSent,     // its number is missing: the camera, or its driver, left it out
  kIncomplete,  // a part of it was lost on its way
  kDamaged,     // it can't be decoded
  kCameraGone,  // nothing came from the camera; how many pictures it would have taken follows from its rate
  kNoRoom,      // the computer was too slow to take it over
  kPassedOver,  // its frame set was ready, but a newer one was judged in its place
  kUnpaired,    // no frame set needed it: another picture of this camera lay nearer to each
};

[[nodiscard]] std::string_view ToString(LossReason reason);  // "not sent", "incomplete", ...
[[nodiscard]] std::optional<LossReason> ParseLossReason(std::string_view text);

// Pictures first to last of one camera.
struct PictureLoss {
  CameraIndex camera = 0;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  LossReason reason = LossReason::kNotSent;

  [[nodiscard]] std::uint64_t count() const { return last - first + 1; }
  [[nodiscard]] bool operator==(const PictureLoss&) const = default;
};

// "camera 'cam2': pictures 120 to 123 were lost (incomplete)".
[[nodiscard]] std::string TextOf(const PictureLoss& loss, std::string_view camera_name);

}  // namespace elbowroom::core
