// What a live camera is set to before it delivers pictures.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace elbowroom::recon {

enum class CaptureTrigger {
  kFree,      // the camera decides
  kSoftware,  // this program asks for each picture
  kHardware,  // a wire does
};

[[nodiscard]] std::string_view ToString(CaptureTrigger trigger);  // "free", "software", "hardware"
[[nodiscard]] std::optional<CaptureTrigger> ParseCaptureTrigger(std::string_view text);

// What RIG.yml says below a camera's `capture`. Where a value is absent, the camera keeps its own.
struct CaptureSettings {
  std::optional<double> rate_hz;          // (0, 1000]
  std::optional<double> exposure_us;      // (0, 1e6]; turns automatic exposure off
  std::optional<double> gain_db;          // [-20, 100]; turns automatic gain off
  std::optional<double> white_balance_k;  // [1000, 20000]; turns automatic white balance off
  CaptureTrigger trigger = CaptureTrigger::kFree;
  // Of GigE Vision and USB3 Vision, by GenICam's name: "RGB8"; empty: colour in as few bytes as there is.
  std::string pixel_format;
  std::optional<int> packet_bytes;  // of GigE Vision, [576, 16000]; absent: as camera and network agree

  [[nodiscard]] bool operator==(const CaptureSettings&) const = default;
};

}  // namespace elbowroom::recon
