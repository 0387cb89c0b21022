// The capture thread of one live camera: it runs the camera's program, counts what comes and what is lost,
// and brings the camera back when it is gone.
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "recon/capture/captured_picture.h"

namespace elbowroom::recon {

// Starts in the constructor. The camera's program (docs/capture.md) is started again, with the same settings,
// whenever it ends, fails, or gives no sign of life; also when a camera that runs freely sends no picture for
// kLongestSilence, or for eight of its periods if that is longer. Thread: any.
class CameraLink {
 public:
  static constexpr std::chrono::milliseconds kLongestSilence{250};

  CameraLink(DeviceRequest request, CaptureHandlers handlers);
  ~CameraLink();
  CameraLink(const CameraLink&) = delete;
  CameraLink& operator=(const CameraLink&) = delete;

  // Asks for a picture of a camera with a software trigger; without effect while it is gone.
  void Trigger();

 private:
  class Session;
  void Run(const std::stop_token& stop);

  DeviceRequest request_;
  CaptureHandlers handlers_;
  std::mutex mutex_;
  std::condition_variable_any wakes_;
  int triggers_ = 0;  // asked for and not yet passed on
  std::jthread thread_;
};

}  // namespace elbowroom::recon
