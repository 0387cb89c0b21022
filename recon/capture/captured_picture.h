// What comes from a live camera: its pictures, those that were lost, and whether it is there.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>

#include "core/picture_loss.h"
#include "recon/capture/device/camera_device.h"

namespace elbowroom::recon {

using CaptureClock = std::chrono::steady_clock;

struct CapturedPicture {
  cv::Mat image_bgr;         // CV_8UC3 of the calibrated size; shared, not to be written to
  std::uint64_t number = 0;  // counts on over interruptions: each number is a picture or a PictureLoss
  CaptureClock::time_point taken_at;    // the middle of its exposure
  CaptureClock::time_point arrived_at;  // when all of it had come to this computer
  StampSource stamp_source = StampSource::kArrival;
};

enum class CameraPresence {
  kStarting,
  kRunning,
  kGone,  // it is looked for all the time
};

struct CameraState {
  CameraPresence presence = CameraPresence::kStarting;
  DeviceReport report;  // of a camera that runs or ran
  std::string trouble;  // of one that is gone: one line
};

// Called on the capture thread of one camera, one at a time; they must not block.
struct CaptureHandlers {
  std::function<void(CapturedPicture)> on_picture;
  std::function<void(core::PictureLoss)> on_loss;  // of this camera; the handler knows its index
  std::function<void(const CameraState&)> on_state;
};

}  // namespace elbowroom::recon
