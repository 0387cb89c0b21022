// The participant's pictures of the demo, with a real tracker.
#include "app/control/participant/participant_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <vector>

#include "app/control/frame_time_tally.h"
#include "app/control/head/head_tracker.h"
#include "app/control/head/udp_port.h"
#include "tests/app/demo_frame.h"

namespace elbowroom::control {
namespace {

// Pictures as they come.
class Gallery {
 public:
  void Add(ParticipantPicture picture) {
    const std::lock_guard lock(mutex_);
    pictures_.push_back(std::move(picture));
    came_.notify_all();
  }
  void AddError(const std::string& line) {
    const std::lock_guard lock(mutex_);
    errors_.push_back(line);
    came_.notify_all();
  }
  // All pictures after the first `known`, as soon as one of them is `wanted`; empty: none came in time.
  template <typename Wanted>
  std::vector<ParticipantPicture> Await(std::size_t known, const Wanted& wanted) {
    std::unique_lock lock(mutex_);
    const bool is_there = came_.wait_for(lock, std::chrono::seconds(60), [&] {
      return std::any_of(pictures_.begin() + static_cast<std::ptrdiff_t>(known), pictures_.end(), wanted);
    });
    if (!is_there) return {};
    return {pictures_.begin() + static_cast<std::ptrdiff_t>(known), pictures_.end()};
  }
  std::size_t size() {
    const std::lock_guard lock(mutex_);
    return pictures_.size();
  }
  std::vector<std::string> errors() {
    const std::lock_guard lock(mutex_);
    return errors_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<ParticipantPicture> pictures_;
  std::vector<std::string> errors_;
};

bool Any(const ParticipantPicture&) { return true; }

// The pictures, a tracker that listens to the loopback interface, and a head that sends.
class Headset {
 public:
  Headset() {
    HeadSettings settings;
    settings.source = recon::HeadSource::kOpenTrack;
    settings.address = "127.0.0.1";
    settings.port = 0;
    settings.world_from_tracker.translation_mm = {60.0, -700.0, 450.0};
    tracker = std::make_unique<HeadTracker>(settings, std::nullopt,
                                            [this](const HeadState& head) { pictures.ShowHead(head); });
    pictures.ShowFrame(DemoFrame());
    pictures.SetLook({{ViewMode::kMono, 63.0, 1.0, 700.0}, {}, 0, 320, 240});
  }

  void Send(const TrackerReading& its) { SendDatagram("127.0.0.1", *tracker->port(), OpenTrackPacket(its)); }
  // Until poses are accepted and drawn.
  void Start() {
    for (int i = 0; i < 200 && tracker->state().is_lost; ++i) {
      reading.position_mm.x() += 0.1;
      (void)SendAndHear();
    }
    (void)gallery.Await(0, Any);
  }
  // Whether the tracker accepted the reading.
  bool SendAndHear() {
    const auto before = tracker->counts();
    const auto heard = [&] { return tracker->counts().all_refused() + tracker->counts().accepted; };
    Send(reading);
    while (heard() == before.all_refused() + before.accepted) std::this_thread::yield();
    return tracker->counts().accepted > before.accepted;
  }

  Gallery gallery;
  ParticipantPictures pictures{[this](ParticipantPicture picture) { gallery.Add(std::move(picture)); },
                               [this](const std::string& line) { gallery.AddError(line); }};
  std::unique_ptr<HeadTracker> tracker;  // posts to `pictures`
  TrackerReading reading{{0.0, 0.0, 0.0}, 0.0, -25.0, 0.0};
};

// The picture that is begun after a pose has come is of that pose: at most the one that is being drawn when
// the packet arrives is of an earlier one.
TEST(ParticipantPictures, APacketReachesThePictureWithinOneFrame) {
  Headset headset;
  FrameTimeTally ages;
  for (int i = 0; i < 40; ++i) {
    headset.Start();  // again, if the machine was so busy that tracking was lost
    const std::size_t known = headset.gallery.size();
    const std::int64_t serial = headset.tracker->state().serial;
    headset.reading.position_mm.x() += 1.0;
    headset.reading.yaw_deg += 0.2;
    if (!headset.SendAndHear()) continue;  // the machine was so busy that tracking was lost meanwhile
    const auto seen = headset.gallery.Await(
        known, [&](const ParticipantPicture& picture) { return picture.serial > serial; });
    ASSERT_FALSE(seen.empty());
    int earlier = 0;
    while (seen[static_cast<std::size_t>(earlier)].serial <= serial) ++earlier;
    EXPECT_LE(earlier, 1);
    const ParticipantPicture& picture = seen[static_cast<std::size_t>(earlier)];
    const core::RigidTransform sent = headset.tracker->settings().WorldFromHead(headset.reading);
    EXPECT_LT((picture.pose.world_from_head.translation_mm - sent.translation_mm).norm(), 1e-9);
    EXPECT_LT((picture.pose.world_from_head.rotation - sent.rotation).norm(), 1e-12);
    ages.Add(std::chrono::duration<double, std::milli>(HeadClock::now() - picture.pose.measured_at).count());
  }
  ASSERT_TRUE(ages.MedianMs().has_value());
  std::cout << "packet to finished picture of 320 x 240: median " << *ages.MedianMs() << " ms, 95 % "
            << *ages.QuantileMs(0.95) << " ms\n";
}

TEST(ParticipantPictures, AreNotMovedByNonsense) {
  Headset headset;
  headset.Start();
  const auto before = headset.tracker->state();
  const auto refused = headset.tracker->counts().all_refused();
  SendDatagram("127.0.0.1", *headset.tracker->port(), std::vector<std::byte>(47));
  TrackerReading nan = headset.reading;
  nan.position_mm.y() = std::numeric_limits<double>::quiet_NaN();
  headset.Send(nan);
  while (headset.tracker->counts().all_refused() < refused + 2) std::this_thread::yield();
  const std::size_t known = headset.gallery.size();
  headset.pictures.ShowFrame(DemoFrame());
  const auto seen = headset.gallery.Await(known, Any);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back().pose.world_from_head, before.pose->world_from_head);
  EXPECT_TRUE(headset.gallery.errors().empty());
}

// One picture of each mode from the fixed eye point.
ParticipantPicture PictureOf(const ParticipantLook& look) {
  Gallery gallery;
  ParticipantPictures pictures([&](ParticipantPicture picture) { gallery.Add(std::move(picture)); },
                               [&](const std::string& line) { gallery.AddError(line); });
  pictures.ShowHead(HeadTracker(HeadSettings{}, std::nullopt).state());
  pictures.ShowFrame(DemoFrame());
  pictures.SetLook(look);
  const auto wanted = [&](const ParticipantPicture& picture) {
    return picture.image.width_px == look.width_px;
  };
  const auto seen = gallery.Await(0, wanted);
  EXPECT_FALSE(seen.empty());
  return seen.empty() ? ParticipantPicture{} : seen.front();
}

TEST(ParticipantPictures, AMirrorExchangesLeftAndRight) {
  const recon::Image mono = PictureOf({{ViewMode::kMono, 63.0, 1.0, 700.0}, {}, 0, 320, 240}).image;
  const recon::Image mirror = PictureOf({{ViewMode::kMirror, 63.0, 1.0, 700.0}, {}, 0, 320, 240}).image;
  ASSERT_EQ(mono.rgb.size(), mirror.rgb.size());
  std::size_t other = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      for (int c = 0; c < 3; ++c)
        other += mono.rgb[static_cast<std::size_t>(3 * (320 * y + x) + c)] !=
                 mirror.rgb[static_cast<std::size_t>(3 * (320 * y + 319 - x) + c)];
  EXPECT_EQ(other, 0U);
}

// The parts are drawn into the camera's picture; the head isn't needed, and left and right can be exchanged.
TEST(ParticipantPictures, ACamerasPictureHasThePartsInIt) {
  const recon::Image there = PictureOf({{ViewMode::kCamera, 63.0, 1.0, 700.0}, {}, 2, 640, 480}).image;
  const recon::Image mirror = PictureOf({{ViewMode::kCameraMirror, 63.0, 1.0, 700.0}, {}, 2, 640, 480}).image;
  const cv::Mat& seen = DemoFrame()->camera_frames->cameras[2].image_bgr;
  ASSERT_EQ(there.width_px, seen.cols);
  ASSERT_EQ(there.height_px, seen.rows);
  std::int64_t drawn = 0, unequal = 0;
  for (int y = 0; y < seen.rows; ++y) {
    for (int x = 0; x < seen.cols; ++x) {
      const auto at = static_cast<std::size_t>(3 * (seen.cols * y + x));
      const auto opposite = static_cast<std::size_t>(3 * (seen.cols * y + seen.cols - 1 - x));
      drawn += there.rgb[at] != seen.at<cv::Vec3b>(y, x)[2];
      unequal += there.rgb[at] != mirror.rgb[opposite];
    }
  }
  EXPECT_GT(drawn, seen.rows * seen.cols / 50);
  EXPECT_LT(drawn, seen.rows * seen.cols * 4 / 5);
  EXPECT_EQ(unequal, 0);
}

// Without a distance between the eyes both see the same.
TEST(ParticipantPictures, StereoOfOneEyeIsTwoEqualPictures) {
  const recon::Image both = PictureOf({{ViewMode::kStereo, 0.0, 1.0, 700.0}, {}, 0, 640, 240}).image;
  ASSERT_EQ(both.width_px, 640);
  constexpr int kKeptLevels =
      2;  // what stays from picture to picture may differ by so much (docs/appearance.md)
  int most = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 3 * 320; ++x)
      most = std::max(most, std::abs(both.rgb[static_cast<std::size_t>(3 * 640 * y + x)] -
                                     both.rgb[static_cast<std::size_t>(3 * 640 * y + 3 * 320 + x)]));
  EXPECT_LE(most, kKeptLevels);
}

}  // namespace
}  // namespace elbowroom::control
