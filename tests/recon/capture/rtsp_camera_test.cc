// Live cameras that send RTSP, on a loopback network of the test's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "recon/capture/live_rig.h"
#include "tests/recon/capture/fake_rtsp_camera.h"
#include "tests/recon/capture/live_accounts.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using testing::FakeRtspCamera;
using ::testing::HasSubstr;
using testing::LiveAccounts;
using testing::NumberedPicture;
using testing::NumberIn;

constexpr int kPort = 8554, kRateHz = 30;
// The encoder likes sizes that its blocks divide.
constexpr int kWidth = 160, kHeight = 96;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new testing::OwnNetwork(1));

class RtspCamera : public ::testing::Test {
 protected:
  void Switch(bool is_on) {
    camera_.reset();
    if (!is_on) return;
    camera_ = std::make_unique<FakeRtspCamera>(kPort, cv::Size(kWidth, kHeight), kRateHz, [](int index) {
      return NumberedPicture(index % 256, kWidth, kHeight);
    });
  }

  [[nodiscard]] static RigFile Rig(int width_px = kWidth) {
    CameraSources source;
    source.frames = "rtsp://127.0.0.1:" + std::to_string(kPort) + "/live";
    source.capture.rate_hz = kRateHz;
    RigFile rig_file = testing::PlainRig({source});
    rig_file.rig.cameras = {testing::PlainCamera("cam1", width_px, kHeight)};
    return rig_file;
  }

  std::unique_ptr<FakeRtspCamera> camera_;
};

TEST_F(RtspCamera, BringsItsPicturesInOrder) {
  Switch(true);
  LiveRig rig(Rig());
  LiveAccounts accounts(1);
  std::optional<std::pair<int, std::uint64_t>> last;
  for (int i = 0; i < 45; ++i) {
    const FrameSet set = rig.Read(i);
    accounts.Add(set);
    const std::pair now(NumberIn(set.cameras[0].image_bgr), set.cameras[0].stamp.value().picture);
    // Numbers go on as the camera's own pictures do.
    if (last) {
      EXPECT_EQ((now.first - last->first + 256) % 256, static_cast<int>(now.second - last->second));
    }
    last = now;
  }
  EXPECT_EQ(rig.states()[0].report.rate_hz, kRateHz);
  accounts.ExpectWhole();
}

TEST_F(RtspCamera, AStreamThatIsCutIsAGapWithItsPicturesNamed) {
  Switch(true);
  LiveRig rig(Rig());
  LiveAccounts accounts(1);
  core::FrameIndex frame = 0;
  for (; frame < 15; ++frame) accounts.Add(rig.Read(frame));
  Switch(false);
  while (rig.states()[0].presence != CameraPresence::kGone) std::this_thread::yield();
  Switch(true);
  for (const core::FrameIndex end = frame + 30; frame < end; ++frame) accounts.Add(rig.Read(frame));
  accounts.ExpectWhole();
  EXPECT_GT(accounts.lost(core::LossReason::kCameraGone), 3U);
}

// A tenth of the pictures arrive with overwritten bytes, some of which no decoder gets over.
TEST_F(RtspCamera, ADamagedStreamCostsPicturesAndNothingElse) {
  camera_ = std::make_unique<FakeRtspCamera>(
      kPort, cv::Size(kWidth, kHeight), kRateHz,
      [](int index) { return NumberedPicture(index % 256, kWidth, kHeight); }, 0.1);
  LiveRig rig(Rig());
  LiveAccounts accounts(1);
  const int sets = 60 * test_support::SoakScale();
  for (int i = 0; i < sets; ++i) accounts.Add(rig.Read(i));
  accounts.ExpectWhole();
  EXPECT_EQ(accounts.judged(), static_cast<std::uint64_t>(sets));
}

TEST_F(RtspCamera, OneOfAnotherSizeIsRefused) {
  Switch(true);
  const std::string message = ErrorOf(ErrorKind::kCamera, [] { LiveRig rig(Rig(192)); });
  EXPECT_THAT(message, HasSubstr("gives 160 x 96 px, but it was calibrated with 192 x 96"));
}

TEST_F(RtspCamera, OneThatIsntThereIsNamed) {
  const std::string message = ErrorOf(ErrorKind::kCamera, [] { LiveRig rig(Rig()); });
  EXPECT_THAT(message, HasSubstr("camera 'cam1': 'rtsp://127.0.0.1:8554/live'"));
  EXPECT_THAT(message, HasSubstr("check the address"));
}

}  // namespace
}  // namespace elbowroom::recon
