// The cap in the pictures of a rig, by the tracker that runs and by the report.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <thread>

#include "app/control/head/head_report.h"
#include "app/control/head/head_tracker.h"
#include "recon/synthetic/rig_presets.h"
#include "tests/recon/head_pose/cap_picture.h"

namespace elbowroom::control {
namespace {

namespace rt = recon::testing;

constexpr double kMostOffMm = 2.0, kMostOffDeg = 0.3;  // what the cap must do

// A head that walks slowly before the four cameras, 15 pictures a second.
class WalkingHead : public recon::FrameSetSource {
 public:
  [[nodiscard]] const core::Rig& rig() const override { return rig_; }
  [[nodiscard]] std::optional<core::FrameIndex> frame_count() const override { return 6; }
  [[nodiscard]] std::string WhatEndsIt() const override { return "the walk"; }
  [[nodiscard]] std::optional<recon::FrameSet> TryRead(core::FrameIndex index, std::stop_token) override {
    if (index >= 6) return std::nullopt;
    recon::FrameSet frames;
    frames.index = index;
    frames.time_s = static_cast<double>(index) / 15.0;
    for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
      const cv::Mat grey = rt::PictureOfCap(cap_, HeadAt(index), rig_.cameras[i], scenes_[i], {}, &random_);
      recon::CameraFrame camera;
      cv::cvtColor(grey, camera.image_bgr, cv::COLOR_GRAY2BGR);
      if (index != 4) frames.cameras.push_back(camera);  // the fifth set has no picture
      if (index == 4) frames.cameras.push_back({});
    }
    return frames;
  }
  [[nodiscard]] std::vector<recon::BackgroundReference> ReadBackgrounds(const core::Progress&,
                                                                        std::stop_token) override {
    return {};
  }

  static core::RigidTransform HeadAt(core::FrameIndex index) {
    std::mt19937 random(17);
    core::RigidTransform head = rt::RandomHead(&random);
    head.translation_mm.x() += 8.0 * static_cast<double>(index);
    return head;
  }

 private:
  core::Rig rig_ = recon::FourCameraRig();
  recon::Cap cap_ = recon::EightSidedCap();
  std::vector<cv::Mat> scenes_ = rt::EmptyScenes(rig_);
  std::mt19937 random_{3};
};

void ExpectNear(const core::RigidTransform& found, const core::RigidTransform& truth) {
  const rt::HeadError error = rt::ErrorOf(found, truth);
  EXPECT_LE(error.distance_mm, kMostOffMm);
  EXPECT_LE(error.turn_deg, kMostOffDeg);
}

TEST(CapTracker, FollowsTheHeadInThePictures) {
  HeadSettings settings;
  settings.source = recon::HeadSource::kCap;
  WalkingHead walk;
  std::vector<SharedFrames> pictures;
  for (core::FrameIndex i = 0; i < 4; ++i)
    pictures.push_back(std::make_shared<const recon::FrameSet>(walk.Read(i)));
  HeadLimits limits;
  limits.most_age = std::chrono::hours(1);  // the machine may be busy
  HeadTracker tracker(settings, walk.rig(), {}, limits);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    tracker.OfferFrames(pictures[i]);
    const auto heard = static_cast<std::int64_t>(i) + 1;
    while (tracker.counts().accepted + tracker.counts().all_refused() < heard) std::this_thread::yield();
  }
  const HeadState state = tracker.state();
  ASSERT_TRUE(state.pose.has_value());
  EXPECT_EQ(tracker.counts().accepted, 2);  // the third and the fourth: the first two are unconfirmed
  EXPECT_EQ(state.pose->source, recon::HeadSource::kCap);
  EXPECT_LT(*state.pose->sigma_mm, 1.0);
  ExpectNear(state.pose->world_from_head, WalkingHead::HeadAt(3));
}

TEST(CapReport, SaysHowWellTheCapIsSeen) {
  WalkingHead walk;
  const HeadReport report = WatchCap(HeadSettings{}, walk, 60.0, {}, {});
  EXPECT_EQ(report.counts.accepted, 5);
  EXPECT_EQ(report.counts.all_refused(), 1);
  EXPECT_EQ(report.not_seen.at("no marker of the cap is seen"), 1);
  EXPECT_LT(*report.sigma_mm, 1.0);
  EXPECT_GE(*report.cameras, 2.0);
  ExpectNear(report.last->world_from_head, WalkingHead::HeadAt(5));
  EXPECT_GT(*report.spread_mm, 8.0);  // it walks
}

TEST(CapReport, EndsWhenItsTimeIsOver) {
  WalkingHead walk;
  EXPECT_EQ(WatchCap(HeadSettings{}, walk, 0.1, {}, {}).counts.accepted, 2);
}

TEST(HeadText, SaysInWordsWhereTheHeadLooks) {
  const core::RigidTransform head = TrackerFromHead({{1.0, -600.0, 400.0}, 10.0, -5.0, 2.0});
  EXPECT_EQ(HeadText(head),
            "eyes at x 1, y -600, z 400 mm; looks 10.0 degrees right, 5.0 down; tilted 2.0 to the right "
            "shoulder");
}

}  // namespace
}  // namespace elbowroom::control
