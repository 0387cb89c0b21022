// A V4L2 driver that a test plays: it answers ioctls as a webcam's does. Containers have no video device.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "recon/capture/v4l2/video_system.h"

namespace elbowroom::recon::testing {

struct PlayedPicture {
  std::vector<std::byte> bytes;
  std::uint32_t sequence = 0;
  std::int64_t stamp_us = 0;
  std::uint32_t more_flags = 0;  // V4L2_BUF_FLAG_ERROR, ..._TSTAMP_SRC_SOE
};

// What the webcam can, and what became of it.
struct PlayedWebcam {
  std::map<std::uint32_t, double> most_rate_hz;  // by pixel format
  std::uint32_t width = 0, height = 0;           // the only size
  std::map<std::uint32_t, std::int32_t> controls;
  std::map<std::uint32_t, std::int32_t> most;  // of controls that are cut off
  std::deque<PlayedPicture> pictures;          // the device is gone after the last one
  double rate_hz = 30.0;
  std::uint32_t format = 0;
  bool is_streaming = false;
  int buffers_out = 0;  // with the driver
};

// `webcam` outlives it.
class PlayedDriver : public VideoSystem {
 public:
  explicit PlayedDriver(PlayedWebcam& webcam) : webcam_(webcam) {}

  int Ioctl(unsigned long request, void* argument) override;
  void* Map(std::size_t length, std::int64_t offset) override;
  void Unmap(void*, std::size_t) override {}
  int Wait(std::chrono::milliseconds) override { return 1; }

 private:
  int Fail(int error);
  int Answer(unsigned long request, void* argument);

  PlayedWebcam& webcam_;
  std::vector<std::vector<std::byte>> buffers_;
  std::deque<std::uint32_t> queued_;
};

}  // namespace elbowroom::recon::testing
