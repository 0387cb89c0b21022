// Live cameras that speak GigE Vision, on a loopback network of the test's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "recon/capture/live_rig.h"
#include "tests/recon/capture/fake_gige_camera.h"
#include "tests/recon/capture/live_accounts.h"
#include "tests/recon/capture/own_network.h"
#include "tests/recon/footage/made_footage.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using testing::FakeGigeCamera;
using testing::FakeSettings;
using ::testing::HasSubstr;
using testing::kHeightPx;
using testing::kWidthPx;
using testing::LiveAccounts;
using testing::LoopbackAddress;
using ::testing::Not;
using testing::NumberedPicture;
using testing::NumberIn;

constexpr int kMostCameras = 8;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new testing::OwnNetwork(kMostCameras));

// Numbered pictures in grey, from cameras at the first addresses.
class GigeCameras : public ::testing::Test {
 protected:
  void Start(int cameras) {
    for (int i = 0; i < cameras; ++i) {
      cameras_.push_back(nullptr);
      Switch(i, true);
    }
  }

  void Switch(int i, bool is_on) {
    cameras_[static_cast<std::size_t>(i)].reset();
    if (!is_on) return;
    cameras_[static_cast<std::size_t>(i)] = std::make_unique<FakeGigeCamera>(
        LoopbackAddress(i), "GV0" + std::to_string(i + 1),
        [this, i](std::int64_t index, const FakeSettings& settings, cv::Mat& pixels) {
          exposure_us_[static_cast<std::size_t>(i)] = settings.exposure_us;
          const cv::Mat picture = NumberedPicture(static_cast<int>(index % 256), pixels.cols, pixels.rows);
          cv::extractChannel(picture, pixels, 0);
          return FakeGigeCamera::Clock::now();
        });
  }

  [[nodiscard]] RigFile Rig() const {
    std::vector<CameraSources> sources;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      CameraSources source;
      source.frames = "gige:" + LoopbackAddress(static_cast<int>(i));
      source.capture.rate_hz = 30.0;
      source.capture.exposure_us = 4000.0;
      source.capture.pixel_format = "Mono8";
      sources.push_back(source);
    }
    return testing::PlainRig(sources);
  }

  std::array<std::atomic<double>, kMostCameras> exposure_us_{};  // that the cameras were last set to
  std::vector<std::unique_ptr<FakeGigeCamera>> cameras_;
};

TEST_F(GigeCameras, BringTheirPicturesInSets) {
  Start(2);
  LiveRig rig(Rig());
  // A busy machine's fake cameras leave a picture out now and then.
  int complete = 0;
  for (int i = 0; complete < 30; ++i) {
    const FrameSet set = rig.Read(i);
    ASSERT_EQ(set.cameras.size(), 2U);
    EXPECT_EQ(set.index, i);
    for (const CameraFrame& frame : set.cameras)
      EXPECT_EQ(frame.image_bgr.size(), frame.stamp ? cv::Size(kWidthPx, kHeightPx) : cv::Size());
    complete += set.cameras[0].stamp && set.cameras[1].stamp ? 1 : 0;
  }
}

TEST_F(GigeCameras, EveryLossIsNamed) {
  Start(2);
  LiveRig rig(Rig());
  LiveAccounts accounts(2);
  std::vector<int> last_content(2, -1);
  std::vector<std::uint64_t> last_number(2, 0);
  cameras_[0]->SetPacketLoss(0.02);
  for (int i = 0; i < 90; ++i) {
    const FrameSet set = rig.Read(i);
    accounts.Add(set);
    for (std::size_t k = 0; k < 2; ++k) {
      if (!set.cameras[k].stamp) continue;
      // Numbers go on as the camera's own pictures do.
      const int content = NumberIn(set.cameras[k].image_bgr);
      const std::uint64_t number = set.cameras[k].stamp->picture;
      if (last_content[k] >= 0) {
        EXPECT_EQ((content - last_content[k] + 256) % 256, static_cast<int>(number - last_number[k]));
      }
      last_content[k] = content;
      last_number[k] = number;
    }
  }
  accounts.ExpectWhole();
  EXPECT_GT(accounts.lost(core::LossReason::kIncomplete) + accounts.lost(core::LossReason::kNotSent), 0U);
}

TEST_F(GigeCameras, OneThatComesBackHasItsSettings) {
  Start(2);
  LiveRig rig(Rig());
  LiveAccounts accounts(2);
  core::FrameIndex frame = 0;
  const auto read_until = [&](auto is_reached) {
    for (;;) {
      const FrameSet set = rig.Read(frame++);
      accounts.Add(set);
      if (is_reached(set)) return;
    }
  };
  read_until([](const FrameSet& set) { return set.cameras[1].stamp.has_value() && set.index > 10; });
  Switch(1, false);
  read_until([&](const FrameSet&) { return rig.states()[1].presence == CameraPresence::kGone; });
  EXPECT_THAT(rig.states()[1].trouble, Not(::testing::IsEmpty()));
  EXPECT_EQ(rig.states()[0].presence, CameraPresence::kRunning);
  Switch(1, true);
  read_until([](const FrameSet& set) { return set.cameras[1].stamp.has_value(); });
  EXPECT_EQ(rig.states()[1].report.exposure_us, 4000.0);
  EXPECT_EQ(exposure_us_[1], 4000.0);
  read_until([&, until = frame + 20](const FrameSet& set) { return set.index >= until; });
  accounts.ExpectWhole();
  EXPECT_GT(accounts.lost(core::LossReason::kCameraGone), 5U);
}

TEST_F(GigeCameras, OneThatIsntThereIsNamed) {
  Start(1);
  RigFile rig_file = Rig();
  rig_file.sources.front().frames = "gige:" + LoopbackAddress(5);
  const std::string message = ErrorOf(ErrorKind::kCamera, [&] { LiveRig rig(rig_file); });
  EXPECT_THAT(message, HasSubstr("camera 'cam1'"));
  EXPECT_THAT(message, HasSubstr("doesn't answer"));
}

}  // namespace
}  // namespace elbowroom::recon
