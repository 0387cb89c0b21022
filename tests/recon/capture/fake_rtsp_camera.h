// A camera in this process that sends its pictures by RTSP, as H.264.
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

namespace elbowroom::recon::testing {

// Thread: any; pictures are asked for on the server's own threads.
class FakeRtspCamera {
 public:
  // Gives picture `index` (0, 1, ...) of a client's stream: CV_8UC3, BGR.
  using Picture = std::function<cv::Mat(int index)>;

  // `damaged_share`: of the encoded pictures, in which some bytes are overwritten. Throws: std::runtime_error
  // where the port is taken.
  FakeRtspCamera(int port, cv::Size size_px, int rate_hz, Picture picture, double damaged_share = 0.0);
  ~FakeRtspCamera();
  FakeRtspCamera(const FakeRtspCamera&) = delete;
  FakeRtspCamera& operator=(const FakeRtspCamera&) = delete;

  [[nodiscard]] std::string url() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::recon::testing
