// A live camera as its driver gives it: opened, set, and then picture after picture. Each kind of camera
// (recon/capture/genicam, v4l2, stream) is one CameraDevice. Only the camera program has any
// (docs/capture.md).
#pragma once

#include <chrono>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "recon/rig_files/capture_settings.h"

namespace elbowroom::recon {

// What is asked of a camera.
struct DeviceRequest {
  std::string location;  // as RIG.yml names it
  int width_px = 0;      // the calibrated size, to which the camera is set
  int height_px = 0;
  CaptureSettings settings;
};

// What a camera says of itself once it is set. Where a value is absent, it can't say.
struct DeviceReport {
  std::string name;  // "Aravis Fake (GV01)"
  std::optional<double> rate_hz;
  std::optional<double> exposure_us;
  std::optional<double> gain_db;
  std::optional<double> white_balance_k;
  std::vector<std::string> warnings;  // what was asked for and isn't so, a line each
};

// When a picture's stamp was taken, and by whom.
enum class StampSource : std::int32_t {
  kDevice,   // the camera's own clock
  kDriver,   // the computer's clock, read by the driver
  kArrival,  // the computer's clock, when the picture had come
};

enum class PictureState : std::int32_t {
  kWhole,
  kIncomplete,  // parts of it were lost on their way
  kDamaged,     // it came, but can't be decoded
};

// One picture that came, whole or not.
struct DevicePicture {
  PictureState state = PictureState::kWhole;
  std::uint64_t number = 0;     // the camera's own count; a gap in it is a loss
  std::int64_t taken_ns = 0;    // the middle of the exposure, on CLOCK_MONOTONIC
  std::int64_t arrived_ns = 0;  // when all of it had come, on CLOCK_MONOTONIC
  StampSource stamp_source = StampSource::kArrival;
};

// Thread: one.
class CameraDevice {
 public:
  virtual ~CameraDevice() = default;

  [[nodiscard]] virtual const DeviceReport& report() const = 0;

  // The next picture; if it is whole, its pixels are in `image_bgr`, CV_8UC3 of the size that was asked for.
  // Nothing: none came in time. Throws: Error{kCamera} when the camera is gone.
  [[nodiscard]] virtual std::optional<DevicePicture> Next(std::chrono::milliseconds most_wait,
                                                          cv::Mat& image_bgr) = 0;

  // Asks for a picture of a camera with a software trigger. Throws: Error{kCamera} as Next.
  virtual void Trigger() {}
};

// The computer's clock that all stamps are on, ns.
[[nodiscard]] std::int64_t MonotonicNs();

}  // namespace elbowroom::recon
