// The messages between this program and a camera program, one for each live camera (docs/capture.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/system/child_process.h"
#include "recon/capture/device/camera_device.h"

namespace elbowroom::recon {

// The camera program lies beside this one (core/system/module.h). It is given its socket and the memory that
// it shares with this program, in this order.
inline constexpr const char* kCameraProgram = "camera";
inline constexpr int kCameraSocket = core::kFirstGivenDescriptor;
inline constexpr int kCameraMemory = core::kFirstGivenDescriptor + 1;

// The shared memory holds this many pictures, one after the other, each in a slot of its own. A slot belongs
// to the camera program until it tells of a picture in it, and again once it is given back.
inline constexpr std::int32_t kPictureSlots = 4;

// The camera program says at least this often that it is well.
inline constexpr std::chrono::milliseconds kSignOfLife{200};

// As location: list the cameras that there are, a line each, and end. No memory is shared then.
inline constexpr std::string_view kListOrder = "list";

// The text after it is the location.
struct CameraOrder {
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  // NaN where the camera keeps its own.
  double rate_hz = 0.0;
  double exposure_us = 0.0;
  double gain_db = 0.0;
  double white_balance_k = 0.0;
  CaptureTrigger trigger = CaptureTrigger::kFree;
  std::int32_t packet_bytes = 0;  // 0: as camera and network agree
  std::array<char, 32> pixel_format{};
};

enum class CameraCommand : std::int32_t { kSlotBack, kTrigger };
struct CommandToCamera {
  CameraCommand command = CameraCommand::kSlotBack;
  std::int32_t slot = 0;
};

enum class CameraNewsKind : std::int32_t {
  kStarted,  // with the settings as read back; the text is the name and the warnings, a line each
  kListed,   // the text is the list
  kPicture,
  kAlive,
  kFailed,  // the text says why; the camera program ends
};

struct CameraNews {
  CameraNewsKind kind = CameraNewsKind::kAlive;
  std::int32_t slot = -1;  // of a picture that is whole; -1: its pixels are not there
  DevicePicture picture{};
  // Of a camera that started; NaN where it can't say.
  double rate_hz = 0.0;
  double exposure_us = 0.0;
  double gain_db = 0.0;
  double white_balance_k = 0.0;
};

[[nodiscard]] CameraOrder OrderFor(const DeviceRequest& request);
[[nodiscard]] DeviceRequest RequestOf(const CameraOrder& order, std::string_view location);
[[nodiscard]] CameraNews NewsOf(const DeviceReport& report);
[[nodiscard]] std::string TextOf(const DeviceReport& report);
[[nodiscard]] DeviceReport ReportOf(const CameraNews& news, std::string_view text);

}  // namespace elbowroom::recon
