// An OpenXR headset by the real loader, the real headset program and a small runtime.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <condition_variable>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include "app/control/head/head_tracker.h"
#include "tests/openxr_runtime/mock_headset.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::control {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using recon::HeadsetPhase;
using test_support::MockEvent;
using test_support::MockHeadset;

constexpr double kFloatMm = 1e-3;  // places of a metre or two come as floats
constexpr std::chrono::seconds kLong(60);

// Until it is so: looked at again and again, while others work.
template <typename Condition>
bool Await(const Condition& is_so) {
  const auto end = HeadClock::now() + kLong;
  while (!is_so()) {
    if (HeadClock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

HeadSettings Settings() {
  HeadSettings settings;
  settings.source = recon::HeadSource::kOpenXr;
  settings.world_from_tracker = core::FromPositionAndRollPitchYaw({50.0, -600.0, -800.0}, {0.0, 0.0, 30.0});
  settings.headset_tried_again = std::chrono::milliseconds(20);
  settings.headset_patience = std::chrono::milliseconds(300);
  return settings;
}

class Headset : public testing::Test {
 protected:
  void Start(std::shared_ptr<HeadsetScreen> screen = nullptr) {
    tracker = std::make_unique<HeadTracker>(Settings(), std::nullopt, OnHeadPose(), HeadLimits(), screen);
  }
  // A head that moves a little, as every head does: its pose is never the same twice.
  void Move(double by_m = 1e-4) {
    place.x() += by_m;
    mock.Put(place, turn);
  }
  bool AwaitTracking() {
    return Await([this] {
      Move(1e-7);
      return !tracker->state().is_lost;
    });
  }
  bool AwaitPhase(HeadsetPhase phase) {
    return Await([this, phase] { return tracker->headset()->phase == phase; });
  }
  // The pose where the mock's head is, worked out apart from the program.
  [[nodiscard]] Vector3d EyesInWorld() const {
    return Settings().world_from_tracker *
           Vector3d(1000.0 * place.x(), -1000.0 * place.z(), 1000.0 * place.y());
  }
  void ExpectNoMisuse() const { EXPECT_EQ(mock.control().misuse, 0) << mock.control().what_misuse.data(); }

  MockHeadset mock;
  Vector3d place{0.2, 1.3, -0.4};
  Quaterniond turn{AngleAxisd(-0.3, Vector3d::UnitY())};
  std::unique_ptr<HeadTracker> tracker;
};

TEST_F(Headset, IsFollowedWithoutGraphics) {
  Start();
  ASSERT_TRUE(AwaitTracking()) << tracker->headset()->text;
  EXPECT_EQ(mock.control().headless_sessions, 1);
  EXPECT_TRUE(AwaitPhase(HeadsetPhase::kFocused));
  EXPECT_EQ(tracker->headset()->name, "Mock runtime 1.2.3, Mock headset");
  for (int i = 0; i < 20; ++i) {
    Move(0.004);
    ASSERT_TRUE(Await([&] {
      const auto state = tracker->state();
      return (state.pose->world_from_head.translation_mm - EyesInWorld()).norm() < kFloatMm;
    }));
  }
  EXPECT_EQ(tracker->state().pose->source, recon::HeadSource::kOpenXr);
  ExpectNoMisuse();
}

// With graphics a pose is of the time when the next picture is shown.
TEST_F(Headset, IsFollowedWithGraphicsAtTheTimeOfTheNextPicture) {
  mock.control().offers_headless = 0;
  mock.control().has_stage = 0;
  mock.Put(place, turn);
  Start();
  ASSERT_TRUE(AwaitTracking()) << tracker->headset()->text;
  EXPECT_EQ(mock.control().headless_sessions, 0);
  const std::int64_t serial = tracker->state().serial;
  ASSERT_TRUE(Await([&] {
    Move(1e-7);
    return tracker->state().serial > serial + 20;
  }));
  const auto ahead = tracker->state().pose->measured_at - HeadClock::now();
  EXPECT_LE(ahead, std::chrono::nanoseconds(test_support::kMockPredictionNs + 8'000'000));
  EXPECT_GE(ahead, -std::chrono::milliseconds(200));
  EXPECT_GT(mock.control().frames, 20);
  EXPECT_EQ(mock.control().frames_with_pictures, 0);
  ExpectNoMisuse();
}

TEST_F(Headset, IsFollowedByARuntimeThatConvertsNoTimes) {
  mock.control().offers_time = 0;  // then it can't be without graphics either
  Start();
  ASSERT_TRUE(AwaitTracking()) << tracker->headset()->text;
  EXPECT_EQ(mock.control().headless_sessions, 0);
  ExpectNoMisuse();
}

TEST_F(Headset, NonsenseMovesNothing) {
  Start();
  ASSERT_TRUE(AwaitTracking());
  const auto refused = [&](PoseFault fault) {
    return tracker->counts().refused[static_cast<std::size_t>(fault)];
  };
  const auto before = tracker->state().pose->world_from_head;
  std::int64_t known = refused(PoseFault::kNotFinite);
  mock.Put({std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0}, turn);
  ASSERT_TRUE(Await([&] { return refused(PoseFault::kNotFinite) > known; }));
  known = refused(PoseFault::kNotFinite);
  mock.Put(place, Quaterniond(0.0, 0.0, 0.0, 0.0));
  ASSERT_TRUE(Await([&] { return refused(PoseFault::kNotFinite) > known; }));
  mock.Put({90.0, 1.0, 0.0}, turn);
  ASSERT_TRUE(Await([&] { return refused(PoseFault::kOutOfReach) > 0; }));
  EXPECT_LT((tracker->state().pose->world_from_head.translation_mm - before.translation_mm).norm(), kFloatMm);
  mock.Put(place, turn);
  ASSERT_TRUE(AwaitTracking());
  // It jumps by 3 m: until tracking is lost nothing moves.
  mock.Put(place + Vector3d(0.0, 0.0, 3.0), turn);
  ASSERT_TRUE(Await([&] { return refused(PoseFault::kJump) > 0; }));
}

TEST_F(Headset, WhatTheRuntimeOnlyGuessesIsNotSeen) {
  Start();
  ASSERT_TRUE(AwaitTracking());
  mock.control().is_tracked = 0;
  ASSERT_TRUE(Await([&] { return tracker->state().is_lost; }));
  EXPECT_GT(tracker->counts().refused[static_cast<std::size_t>(PoseFault::kNotSeen)], 0);
  mock.control().is_tracked = 1;
  EXPECT_TRUE(AwaitTracking());
}

TEST_F(Headset, ASessionPausesAndGoesOn) {
  mock.control().begins_by_itself = 0;
  Start();
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kIdle));
  EXPECT_TRUE(tracker->state().is_lost);
  for (const MockEvent event : {MockEvent::kReady, MockEvent::kSynchronized, MockEvent::kVisible})
    mock.Tell(event);
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kVisible));
  ASSERT_TRUE(AwaitTracking());
  mock.Tell(MockEvent::kStopping);
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kStopping));
  ASSERT_TRUE(Await([&] { return tracker->state().is_lost; }));
  for (const MockEvent event : {MockEvent::kIdle, MockEvent::kReady, MockEvent::kSynchronized,
                                MockEvent::kVisible, MockEvent::kFocused})
    mock.Tell(event);
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kFocused));
  ASSERT_TRUE(AwaitTracking());
  EXPECT_EQ(mock.control().begun, 2);
  EXPECT_EQ(mock.control().ended, 1);
  mock.Tell(MockEvent::kRecentred);
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kRecentred));
  EXPECT_NE(tracker->headset()->text.find("register"), std::string::npos);
  mock.Tell(MockEvent::kStopping);
  mock.Tell(MockEvent::kExiting);
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kEnded));
  EXPECT_EQ(mock.control().instances, 1);
  ExpectNoMisuse();
}

// Each way in which a runtime can go: it is told, and tried again.
class HeadsetThatVanishes : public Headset, public testing::WithParamInterface<int> {};

TEST_P(HeadsetThatVanishes, IsToldAndFoundAgain) {
  Start();
  ASSERT_TRUE(AwaitTracking());
  const auto lost = [&] { return mock.control().instances >= 2; };
  switch (GetParam()) {
    case 0:
      mock.Tell(MockEvent::kInstanceLoss);
      break;
    case 1:
      mock.Tell(MockEvent::kLossPending);
      break;
    case 2:
      mock.control().vanishes = 1;
      ASSERT_TRUE(AwaitPhase(HeadsetPhase::kLost));
      EXPECT_NE(tracker->headset()->text.find("XR_ERROR_INSTANCE_LOST"), std::string::npos)
          << tracker->headset()->text;
      mock.control().vanishes = 0;
      break;
    case 3:
      mock.control().crashes = 1;
      ASSERT_TRUE(AwaitPhase(HeadsetPhase::kLost));
      EXPECT_NE(tracker->headset()->text.find("crashed (ABRT)"), std::string::npos)
          << tracker->headset()->text;
      mock.control().crashes = 0;
      break;
  }
  ASSERT_TRUE(Await(lost));
  EXPECT_TRUE(AwaitPhase(HeadsetPhase::kFocused)) << tracker->headset()->text;
  EXPECT_TRUE(AwaitTracking());
}

INSTANTIATE_TEST_SUITE_P(Ways, HeadsetThatVanishes, testing::Range(0, 4));

TEST_F(Headset, ACallThatDoesNotReturnBlocksNobody) {
  Start();
  ASSERT_TRUE(AwaitTracking());
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kFocused));
  mock.control().hangs = 1;
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kSilent));
  EXPECT_TRUE(tracker->state().is_lost);
  mock.control().hangs = 0;
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kFocused));
  ASSERT_TRUE(AwaitTracking());
  mock.control().hangs = 1;
  ASSERT_TRUE(AwaitPhase(HeadsetPhase::kSilent));
  tracker.reset();  // returns while the call still hangs
}

// What is missing is said in one line, which names it.
TEST_F(Headset, SaysWhatIsMissing) {
  const auto refused = [&] {
    Start();
    EXPECT_TRUE(AwaitPhase(HeadsetPhase::kRefused));
    const std::string text = tracker->headset()->text;
    tracker.reset();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    return text;
  };
  mock.control().has_headset = 0;
  EXPECT_NE(refused().find("switched on"), std::string::npos);
  mock.control().has_headset = 1;
  mock.control().offers_headless = mock.control().offers_egl = 0;
  EXPECT_NE(refused().find("XR_MNDX_egl_enable"), std::string::npos);
  mock.control().offers_egl = 1;
  mock.control().refuses_session = 1;
  EXPECT_NE(refused().find("session"), std::string::npos);
  mock.control().refuses_instance = 1;
  EXPECT_NE(refused().find("service"), std::string::npos);
  ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
  EXPECT_NE(refused().find("no OpenXR runtime answers"), std::string::npos);
}

TEST_F(Headset, SaysThatThereIsNoLoader) {
  const test_support::TemporaryFolder folder;  // its "loader" stands before the system's
  test_support::WriteText(folder / "libopenxr_loader.so.1", "This is no library.\n");
  ::setenv("LD_LIBRARY_PATH", folder.path().c_str(), 1);
  Start();
  EXPECT_TRUE(AwaitPhase(HeadsetPhase::kRefused));
  ::unsetenv("LD_LIBRARY_PATH");
  EXPECT_NE(tracker->headset()->text.find("libopenxr-loader1"), std::string::npos)
      << tracker->headset()->text;
  EXPECT_EQ(mock.control().instances, 0);
}

// Each byte arrives: the upper row first, the left eye's on the left, from where it was drawn.
TEST_F(Headset, ShowsThePicturesThatItIsGiven) {
  mock.control().eyes[0].turned_outwards_rad = mock.control().eyes[1].turned_outwards_rad = 0.1;
  const auto screen = std::make_shared<HeadsetScreen>();
  mock.Put(place, turn);
  Start(screen);
  ASSERT_TRUE(AwaitTracking()) << tracker->headset()->text;
  EXPECT_EQ(screen->recommended_px()[0], test_support::kMockEyeWidthPx);
  EXPECT_EQ(screen->recommended_px()[1], test_support::kMockEyeHeightPx);
  std::mt19937 random(5);
  std::array<std::vector<std::uint8_t>, 2> pixels;
  std::array<recon::EyePicture, 2> eyes;
  for (std::size_t i = 0; i < 2; ++i) {
    eyes[i].width_px = 200 + static_cast<int>(i);
    eyes[i].height_px = 121;
    pixels[i].resize(static_cast<std::size_t>(3 * eyes[i].width_px * eyes[i].height_px));
    for (auto& value : pixels[i]) value = static_cast<std::uint8_t>(random());
    eyes[i].rgb = pixels[i];
    eyes[i].seen = {-0.9, 0.5 + 0.1 * static_cast<double>(i), 0.4, -0.6};
  }
  const auto pose = *tracker->state().pose;
  ASSERT_TRUE(Await([&] { return screen->Show(pose.eyes->pose, eyes); }));
  place.x() += 0.03;  // the head has moved on: the picture stays where it was drawn for
  mock.Put(place, turn);
  ASSERT_TRUE(Await([&] { return mock.control().frames_with_pictures > 3; }));
  const auto shown = mock.Pictures();
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(shown[i].width_px, eyes[i].width_px);
    ASSERT_EQ(shown[i].height_px, eyes[i].height_px);
    EXPECT_TRUE(std::equal(pixels[i].begin(), pixels[i].end(), shown[i].rgb.begin()));
    EXPECT_NEAR(std::tan(shown[i].fov[0]), eyes[i].seen.left, 1e-6);
    EXPECT_NEAR(std::tan(shown[i].fov[1]), eyes[i].seen.right, 1e-6);
    EXPECT_NEAR(std::tan(shown[i].fov[2]), eyes[i].seen.up, 1e-6);
    EXPECT_NEAR(std::tan(shown[i].fov[3]), eyes[i].seen.down, 1e-6);
    const Vector3d eye_mm = (pose.world_from_head * pose.eyes->eyes[i].head_from_eye).translation_mm;
    const Vector3d at(shown[i].pose.position[0], shown[i].pose.position[1], shown[i].pose.position[2]);
    EXPECT_LT((Settings().world_from_tracker * Vector3d(1000.0 * at.x(), -1000.0 * at.z(), 1000.0 * at.y()) -
               eye_mm)
                  .norm(),
              kFloatMm);
  }
  ExpectNoMisuse();
}

}  // namespace
}  // namespace elbowroom::control
