// Live cameras that speak GigE Vision, on a loopback network of the test's own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "recon/capture/live_rig.h"
#include "tests/recon/capture/fake_gige_camera.h"
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
using testing::LoopbackAddress;
using testing::NumberedPicture;
using testing::NumberIn;

constexpr int kMostCameras = 8;

class OwnNetwork : public ::testing::Environment {
  void SetUp() override { testing::EnterOwnNetwork(kMostCameras); }
};
const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new OwnNetwork);

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
        [](std::int64_t index, const FakeSettings&, cv::Mat& pixels) {
          const cv::Mat picture = NumberedPicture(static_cast<int>(index % 256), pixels.cols, pixels.rows);
          cv::extractChannel(picture, pixels, 0);
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

  std::vector<std::unique_ptr<FakeGigeCamera>> cameras_;
};

TEST_F(GigeCameras, BringTheirPicturesInSets) {
  Start(2);
  LiveRig rig(Rig());
  for (int i = 0; i < 30; ++i) {
    const FrameSet set = rig.Read(i);
    ASSERT_EQ(set.cameras.size(), 2U);
    EXPECT_EQ(set.index, i);
    for (const CameraFrame& frame : set.cameras) {
      ASSERT_TRUE(frame.stamp.has_value());
      EXPECT_EQ(frame.image_bgr.size(), cv::Size(kWidthPx, kHeightPx));
    }
  }
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
