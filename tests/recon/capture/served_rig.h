// Frame sets served as live pictures by GigE Vision cameras in this process, one for each camera of the rig.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "recon/footage/frame_set.h"
#include "recon/rig_files/rig_file.h"
#include "tests/recon/capture/fake_gige_camera.h"

namespace elbowroom::recon::testing {

// The cameras run by one clock: all take the picture of one set at one instant, and the sets come one after
// the other, again and again. Thread: any.
class ServedRig {
 public:
  // Serves at LoopbackAddress(0) and on. Throws: std::runtime_error as FakeGigeCamera.
  ServedRig(std::vector<FrameSet> sets, double rate_hz);

  // How RIG.yml names camera `i`, with the settings that keep its pixels as they are.
  [[nodiscard]] CameraSources SourcesOf(std::size_t i) const;

  void Switch(std::size_t camera, bool is_on);
  void SetPacketLoss(std::size_t camera, double share) { cameras_.at(camera)->SetPacketLoss(share); }

 private:
  std::chrono::steady_clock::time_point Fill(std::size_t camera, cv::Mat& pixels) const;
  [[nodiscard]] std::chrono::steady_clock::time_point TimeOf(std::int64_t count) const;

  std::vector<FrameSet> sets_;
  double rate_hz_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::vector<std::unique_ptr<FakeGigeCamera>> cameras_;
};

}  // namespace elbowroom::recon::testing
