// A GigE Vision camera in this process (Aravis' fake camera): the protocol is real, the pictures are ours.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

namespace elbowroom::recon::testing {

struct FakeSettings {
  double exposure_us = 0.0;
  std::uint32_t gain = 0;
};

// Thread: any; pictures are asked for on the camera's own thread.
class FakeGigeCamera {
 public:
  using Clock = std::chrono::steady_clock;
  // Fills the pixels of picture `index` (0, 1, ...): CV_8UC1 for a Mono8 or Bayer format, else CV_8UC3 in the
  // order RGB. Returns when it was taken, for the camera's stamp.
  using Fill = std::function<Clock::time_point(std::int64_t index, const FakeSettings&, cv::Mat& pixels)>;

  // Throws: std::runtime_error where `address` isn't one of this computer, or is taken.
  FakeGigeCamera(const std::string& address, const std::string& serial, Fill fill);
  ~FakeGigeCamera();
  FakeGigeCamera(const FakeGigeCamera&) = delete;
  FakeGigeCamera& operator=(const FakeGigeCamera&) = delete;

  // The share of packets that are lost from now on.
  void SetPacketLoss(double share);
  [[nodiscard]] std::int64_t pictures_sent() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon::testing
