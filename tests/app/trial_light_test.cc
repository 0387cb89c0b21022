#include "app/control/light/trial_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/recon/light/light_scene.h"

namespace elbowroom::control {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kBrighter = "camera 'cam1': the light is 12 % brighter";
const std::string kBrighterStill = "camera 'cam1': the light is 9.5 % brighter";

TEST(AdviceLog, TellsAdviceOnceAndWhenItNoLongerHolds) {
  AdviceLog log;
  EXPECT_THAT(log.Add("cam1", {kBrighter}, 0.0), ElementsAre(kBrighter));
  EXPECT_THAT(log.Add("cam1", {kBrighterStill}, 5.0), IsEmpty());
  EXPECT_THAT(log.Add("cam2", {}, 70.0), IsEmpty());
  EXPECT_THAT(log.Add("cam1", {}, 64.9), IsEmpty());
  EXPECT_THAT(log.Add("cam1", {}, 65.0), ElementsAre("no longer: " + kBrighter));
  EXPECT_THAT(log.Add("cam1", {}, 70.0), IsEmpty());
  EXPECT_THAT(log.Add("cam1", {kBrighterStill}, 75.0), ElementsAre(kBrighterStill));
  EXPECT_THAT(log.given(), ElementsAre(kBrighter, kBrighterStill));
}

TEST(AdviceLog, LightAtALimitGivesOneNote) {
  AdviceLog log;
  int notes = 0;
  for (int report = 0; report < 100; ++report) {
    const std::vector<std::string> advice =
        report % 2 == 0 ? std::vector{kBrighter} : std::vector<std::string>();
    notes += static_cast<int>(log.Add("cam1", advice, 5.0 * report).size());
  }
  EXPECT_EQ(notes, 1);
}

core::CameraModel CameraOf320x240(const std::string& name) {
  core::CameraCalibration calibration;
  calibration.name = name;
  calibration.image_width_px = 320;
  calibration.image_height_px = 240;
  calibration.camera_matrix << 300.0, 0.0, 160.0, 0.0, 300.0, 120.0, 0.0, 0.0, 1.0;
  return core::CameraModel(calibration);
}

// Two cameras that look at one drawn table.
class WatchedTrial : public ::testing::Test {
 protected:
  WatchedTrial() {
    rig_.cameras = {CameraOf320x240("cam1"), CameraOf320x240("cam2")};
    backgrounds_ = {scene_.Background(), scene_.Background()};
  }

  // Sends pictures of ten seconds; the second camera's are missing where `second_is_there` is false.
  void Play(TrialLight* light, double gain, bool second_is_there = true) const {
    constexpr double kRateHz = 15.0;
    for (int i = 0; i < 10.0 * kRateHz; ++i) {
      const double time_s = i / kRateHz;
      const recon::DrawnPicture drawn = scene_.At(time_s, {gain, gain, gain}, false);
      auto frames = std::make_shared<recon::FrameSet>();
      frames->time_s = time_s;
      frames->cameras = {{drawn.image_bgr}, {second_is_there ? drawn.image_bgr : cv::Mat()}};
      auto masks = std::make_shared<const std::vector<core::SoftMask>>(2, core::SoftMask{drawn.mask, {}});
      light->Offer(std::move(frames), std::move(masks));
    }
    light->Finish();
  }

  recon::LightScene scene_{recon::TableGround::kGreyTable, 2.0, 11};
  core::Rig rig_;
  std::vector<recon::BackgroundReference> backgrounds_;
  recon::SegmentationOptions segmentation_;
};

TEST_F(WatchedTrial, AdviceIsANoteOfTheSessionOnceACamera) {
  int reports = 0;
  TrialLight light(rig_, backgrounds_, segmentation_, [&](const recon::LightReport&) { ++reports; });
  Play(&light, 1.3);
  const std::vector<std::string> notes = light.TakeNotes();
  EXPECT_THAT(notes, ::testing::UnorderedElementsAre(HasSubstr("camera 'cam1': the light is 30 % brighter"),
                                                     HasSubstr("camera 'cam2': the light is 30 % brighter")));
  EXPECT_EQ(light.advice(), notes);
  EXPECT_THAT(light.TakeNotes(), IsEmpty());
  ASSERT_THAT(light.reports(), SizeIs(2));
  EXPECT_NEAR(light.reports()[0].gain, 1.3, 0.01);
  EXPECT_GE(reports, 2);
}

TEST_F(WatchedTrial, SteadyLightGivesNone) {
  TrialLight light(rig_, backgrounds_, segmentation_);
  Play(&light, 1.0);
  EXPECT_THAT(light.TakeNotes(), IsEmpty());
  ASSERT_THAT(light.reports(), SizeIs(2));
  EXPECT_NEAR(light.reports()[1].gain, 1.0, 0.01);
}

TEST_F(WatchedTrial, SegmentationThatFollowsTheLightNeedsNoAdvice) {
  segmentation_.method = recon::SegmentationMethod::kAdaptive;
  TrialLight light(rig_, backgrounds_, segmentation_);
  Play(&light, 1.3);
  EXPECT_THAT(light.TakeNotes(), IsEmpty());
  EXPECT_NEAR(light.reports().at(0).gain, 1.3, 0.01);
}

TEST_F(WatchedTrial, CamerasWithReadyMasksOrWithoutPicturesAreLeftOut) {
  backgrounds_[0] = {};
  TrialLight light(rig_, backgrounds_, segmentation_);
  Play(&light, 1.3, false);
  ASSERT_THAT(light.reports(), SizeIs(1));
  EXPECT_EQ(light.reports()[0].camera, "cam2");
  EXPECT_EQ(light.reports()[0].gain, 1.0);  // no picture came
  EXPECT_THAT(light.TakeNotes(), IsEmpty());
}

TEST_F(WatchedTrial, NeedsABackgroundACamera) {
  backgrounds_.pop_back();
  EXPECT_THROW(TrialLight(rig_, backgrounds_, segmentation_), core::PreconditionError);
}

}  // namespace
}  // namespace elbowroom::control
