// Cameras of the network that send JPEG pictures by HTTP, and those that misbehave: pictures that are none,
// silence, no answer at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <thread>

#include "recon/capture/live_rig.h"
#include "tests/recon/capture/live_accounts.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/recon/footage/mjpeg_server.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using core::ErrorKind;
using testing::ErrorOf;
using testing::Jpeg;
using testing::LiveAccounts;
using testing::MjpegServer;
using testing::NumberIn;

// What somebody who pressed Ctrl-C waits at most.
constexpr std::chrono::seconds kPatience{2};

RigFile RigOf(const MjpegServer& server) {
  CameraSources sources;
  sources.frames = server.url();
  return testing::PlainRig({sources});
}

// The parts at a camera's rate.
MjpegServer::Part AtItsRate(const std::function<std::optional<std::string>(int)>& part) {
  return [part, begin = std::chrono::steady_clock::now()](int index) {
    std::this_thread::sleep_until(begin + index * std::chrono::milliseconds(40));
    return part(index);
  };
}

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

TEST(HttpCamera, BringsItsPicturesInOrder) {
  MjpegServer server(AtItsRate([](int i) { return Jpeg(i % 256); }));
  LiveRig rig(RigOf(server));
  LiveAccounts accounts(1);
  int last = -1;
  std::uint64_t last_picture = 0;
  for (int i = 0; i < 40; ++i) {
    const FrameSet set = rig.Read(i);
    accounts.Add(set);
    const int number = NumberIn(set.cameras[0].image_bgr);
    const std::uint64_t picture = set.cameras[0].stamp.value().picture;
    if (last >= 0) {
      EXPECT_EQ((number - last + 256) % 256, static_cast<int>(picture - last_picture));
    }
    last = number;
    last_picture = picture;
  }
  accounts.ExpectWhole();
}

TEST(HttpCamera, DamagedPicturesAreNamed) {
  const auto part = [](int i) {
    if (i % 20 == 13) return std::string(700, 'g');  // none at all
    return Jpeg(i % 256);
  };
  MjpegServer server(AtItsRate(part));
  LiveRig rig(RigOf(server));
  LiveAccounts accounts(1);
  for (int i = 0; i < 50; ++i) accounts.Add(rig.Read(i));
  accounts.ExpectWhole();
  EXPECT_GE(accounts.lost(core::LossReason::kDamaged), 1U);
}

// JPEG files that are cut, overwritten, or claim to be huge: between them whole ones come through.
TEST(HttpCamera, ManyDamagedPicturesCostThemselvesAndNothingElse) {
  const int parts = 200 * test_support::SoakScale();
  std::mt19937 random(3);
  const auto part = [&](int i) {
    std::string jpeg = Jpeg(i % 256);
    if (i % 4 == 0) return jpeg;
    const auto below = [&](std::size_t end) {
      return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
    };
    switch (i % 4) {
      case 1:
        jpeg.resize(below(jpeg.size()));
        break;
      case 2:
        for (int k = 0; k < 10; ++k) jpeg[below(jpeg.size())] = static_cast<char>(below(256));
        break;
      default: {  // its header claims 65,500 x 65,500 pixels
        const std::size_t at = jpeg.find("\xff\xc0");
        if (at != std::string::npos) jpeg.replace(at + 5, 4, "\xff\xdc\xff\xdc");
      }
    }
    return jpeg;
  };
  MjpegServer server([&](int i) -> std::optional<std::string> {
    static const auto begin = std::chrono::steady_clock::now();
    std::this_thread::sleep_until(begin + i * std::chrono::milliseconds(10));
    return i < parts ? std::optional(part(i)) : std::optional(Jpeg(7));
  });
  LiveRig rig(RigOf(server));
  LiveAccounts accounts(1);
  for (int i = 0; accounts.judged() < static_cast<std::uint64_t>(parts) / 5; ++i) {
    const FrameSet set = rig.Read(i);
    accounts.Add(set);
    EXPECT_EQ(set.cameras[0].image_bgr.cols, testing::kWidthPx);
  }
  accounts.ExpectWhole();
}

TEST(HttpCamera, AStopIsHeardWhileItStalls) {
  MjpegServer server(AtItsRate([](int i) { return i < 20 ? std::optional(Jpeg(i)) : std::nullopt; }));
  LiveRig rig(RigOf(server));
  EXPECT_LT(TimeToStop(server,
                       [&](const std::stop_token& stop) {
                         for (int i = 0;; ++i) (void)rig.Read(i, stop);
                       }),
            kPatience);
}

TEST(HttpCamera, AStopIsHeardWhileNobodyAnswers) {
  MjpegServer server(nullptr);
  EXPECT_LT(TimeToStop(server,
                       [&](const std::stop_token& stop) { (void)LiveRig(RigOf(server), LiveTaps(), stop); }),
            kPatience);
}

}  // namespace
}  // namespace elbowroom::recon
