// Cameras of the network that misbehave, on this machine: pictures that are none, silence, no answer at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "recon/footage/image_source.h"
#include "recon/footage/recorded_rig.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/recon/footage/mjpeg_server.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::Jpeg;
using testing::MjpegServer;
using testing::NumberIn;
using testing::PlainCamera;
using testing::PlainRig;

// What somebody who pressed Ctrl-C waits at most.
constexpr std::chrono::seconds kPatience{2};

// How long `action` takes to throw Error{kCancelled} after `stop`, once the server stalls.
std::chrono::duration<double> TimeToStop(MjpegServer& server,
                                         const std::function<void(std::stop_token)>& action) {
  std::stop_source stop;
  std::future<void> cancelled = std::async(
      std::launch::async, [&] { (void)ErrorOf(ErrorKind::kCancelled, [&] { action(stop.get_token()); }); });
  server.WaitUntilItStalls();
  const auto begin = std::chrono::steady_clock::now();
  stop.request_stop();
  cancelled.wait();
  return std::chrono::steady_clock::now() - begin;
}

TEST(LiveStream, BringsItsPicturesInOrder) {
  MjpegServer server([](int i) { return Jpeg(i % 256); });
  const auto source = OpenImageSource(server.url(), PlainCamera("cam3"));
  EXPECT_FALSE(source->frame_count().has_value());
  for (int i = 0; i < 60; ++i) EXPECT_EQ(NumberIn(source->Read(i).value().image_bgr), i);
  EXPECT_EQ(source->left_out(), 0);
}

TEST(LiveStream, SaysOfEveryCameraWhenItsPictureCame) {
  MjpegServer one([](int i) { return Jpeg(i % 256); });
  MjpegServer other([](int i) { return Jpeg(i % 256); });
  const auto begin = std::chrono::steady_clock::now();
  RecordedRig rig(PlainRig({{one.url(), "", ""}, {other.url(), "", ""}}));
  std::vector<std::chrono::steady_clock::time_point> last(2, begin);
  std::optional<std::chrono::steady_clock::time_point> first;
  for (core::FrameIndex i = 0; i < 5; ++i) {
    const FrameSet set = rig.Read(i);
    for (std::size_t camera = 0; camera < 2; ++camera) {
      ASSERT_TRUE(set.cameras[camera].captured_at.has_value());
      EXPECT_GT(*set.cameras[camera].captured_at, last[camera]);
      last[camera] = *set.cameras[camera].captured_at;
    }
    if (!first) first = last[0];
    EXPECT_DOUBLE_EQ(set.time_s, std::chrono::duration<double>(last[0] - *first).count());
  }
}

TEST(LiveStream, LeavesDamagedPicturesOutAndCountsThem) {
  const auto part = [](int i) {
    if (i % 20 == 13) return std::string(700, 'g');  // none at all
    if (i % 20 == 17)
      return Jpeg(i % 256).substr(0, 620) + std::string(80, '\x55') + "\xff\xd9";  // half of one
    return Jpeg(i % 256);
  };
  MjpegServer server(part);
  const auto source = OpenImageSource(server.url(), PlainCamera("cam3"));
  core::FrameIndex index = 0;
  for (int i = 0; i < 100; ++i) {
    if (i % 20 == 13 || i % 20 == 17) continue;
    EXPECT_EQ(NumberIn(source->Read(index++).value().image_bgr), i);
  }
  EXPECT_EQ(source->left_out(), 10);
}

TEST(LiveStream, ARigSaysHowManyWereLeftOut) {
  MjpegServer server([](int i) { return i == 30 ? std::string(700, 'g') : Jpeg(i % 256); });
  RecordedRig rig(PlainRig({{server.url(), "", ""}}));
  EXPECT_TRUE(rig.Warnings().empty());
  int last = 0;
  for (core::FrameIndex i = 0; last < 40; ++i) last = NumberIn(rig.Read(i).cameras[0].image_bgr);
  EXPECT_THAT(rig.Warnings(), ElementsAre("camera 'cam1': 1 damaged live picture was left out"));
}

TEST(LiveStream, EndsWhenNothingButDamageComes) {
  MjpegServer server([](int i) { return i < 40 ? Jpeg(i) : std::string(700, 'g'); });
  const auto source = OpenImageSource(server.url(), PlainCamera("cam3"));
  const std::string message = ErrorOf(ErrorKind::kCamera, [&] {
    for (int i = 0;; ++i) (void)source->Read(i);
  });
  EXPECT_THAT(message,
              AllOf(HasSubstr("cam3"), HasSubstr("frame 40"), HasSubstr("damaged pictures were left out")));
  EXPECT_GE(source->left_out(), 8);
}

TEST(LiveStream, AStopIsHeardWhileItStalls) {
  MjpegServer server([](int i) { return i < 40 ? std::optional(Jpeg(i)) : std::nullopt; });
  const auto source = OpenImageSource(server.url(), PlainCamera("cam3"));
  EXPECT_LT(TimeToStop(server,
                       [&](const std::stop_token& stop) {
                         for (int i = 0;; ++i) (void)source->Read(i, stop);
                       }),
            kPatience);
}

TEST(LiveStream, AStopIsHeardByARigThatReadsAhead) {
  MjpegServer server([](int i) { return i < 40 ? std::optional(Jpeg(i)) : std::nullopt; });
  std::optional<RecordedRig> rig(std::in_place, PlainRig({{server.url(), "", ""}}));
  EXPECT_LT(TimeToStop(server,
                       [&](const std::stop_token& stop) {
                         for (int i = 0;; ++i) (void)rig->Read(i, stop);
                       }),
            kPatience);
  const auto begin = std::chrono::steady_clock::now();
  rig.reset();  // its thread still waits for a picture
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kPatience);
}

TEST(LiveStream, AStopIsHeardWhileNobodyAnswers) {
  MjpegServer server(nullptr);
  EXPECT_LT(TimeToStop(server,
                       [&](const std::stop_token& stop) {
                         (void)RecordedRig(PlainRig({{server.url(), "", ""}}), stop);
                       }),
            kPatience);
}

}  // namespace
}  // namespace elbowroom::recon
