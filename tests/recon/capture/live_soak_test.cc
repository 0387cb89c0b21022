// Eight GigE Vision cameras for a long time: every picture accounted for, cameras that go and come back,
// memory that stays.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/spread.h"
#include "recon/capture/live_rig.h"
#include "tests/recon/capture/camera_farm.h"
#include "tests/recon/capture/live_accounts.h"
#include "tests/recon/capture/own_network.h"
#include "tests/support/soak.h"

namespace elbowroom::recon {
namespace {

using testing::CameraFarm;
using testing::LiveAccounts;
using Clock = std::chrono::steady_clock;

constexpr int kCameras = 8;
constexpr double kRateHz = 30.0;
// At scale 1; half an hour at 30.
constexpr double kSeconds = 60.0;
constexpr double kMegabyte = 1024.0 * 1024.0;

const auto* const kNetwork = ::testing::AddGlobalTestEnvironment(new testing::OwnNetwork(kCameras));

// What this process and its camera programs have in memory that is theirs alone; but for what this process
// has freed and its C library keeps.
double OwnMemoryBytes() {
  ::malloc_trim(0);
  double bytes = 0.0;
  const auto add = [&](const std::filesystem::path& process) {
    std::ifstream file(process / "smaps_rollup");
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("Private_Dirty:")) bytes += 1024.0 * std::stod(line.substr(14));
    }
  };
  add("/proc/self");
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string number, name, state;
    pid_t parent = 0;
    if (file >> number >> name >> state >> parent && parent == ::getpid() &&
        name.starts_with("(elbowroom_camer"))
      add(entry.path());
  }
  return bytes;
}

// The least memory within a part of the time. More pictures than the pool holds are on their way when a
// processor is late: that memory comes and goes, and a leak stays.
class LeastMemory {
 public:
  LeastMemory(double begin_s, double end_s) : next_s_(begin_s), end_s_(end_s) {}

  void Look(double now_s) {
    if (now_s < next_s_ || now_s > end_s_) return;
    least_bytes_ = std::min(least_bytes_, OwnMemoryBytes());
    next_s_ = now_s + kEveryS;
  }
  [[nodiscard]] double bytes() const { return least_bytes_; }

 private:
  static constexpr double kEveryS = 0.25;

  double next_s_, end_s_;
  double least_bytes_ = std::numeric_limits<double>::infinity();
};

void Print(const char* what, std::vector<double> ms) {
  if (ms.empty()) return;
  std::ranges::sort(ms);
  std::printf("%s, ms: median %.2f, 99 %% %.2f, worst %.2f\n", what, core::PercentileOf(ms, 0.5),
              core::PercentileOf(ms, 0.99), ms.back());
}

TEST(LiveSoak, EightCamerasAreAccountedForAndKeepTheirMemory) {
  CameraFarm farm(kCameras);
  std::vector<double> decision_ms;
  std::mutex mutex;
  LiveTaps taps;
  taps.on_set = [&](const DecidedSet& decided) {
    Clock::time_point last = Clock::time_point::min();
    for (const auto& picture : decided.set.pictures)
      if (picture) last = std::max(last, picture->arrived_at);
    const std::lock_guard lock(mutex);
    decision_ms.push_back(std::chrono::duration<double, std::milli>(decided.decided_at - last).count());
  };
  const double seconds = kSeconds * test_support::SoakScale();
  decision_ms.assign(static_cast<std::size_t>(2.0 * kRateHz * seconds),
                     1.0);  // its memory is there from now on
  decision_ms.clear();
  LiveRig rig(farm.Rig(kRateHz), std::move(taps));
  LiveAccounts accounts(kCameras);
  farm.SetPacketLoss(5, 1e-4);

  // A camera goes at a fifth of the time and at three fifths, and comes back two seconds later.
  struct Outage {
    int camera;
    double off_s;
    bool is_off = false, is_back = false;
    Clock::time_point on_at{};
  };
  std::vector<Outage> outages{{2, 0.2 * seconds}, {0, 0.6 * seconds}};
  std::vector<double> back_ms;
  LeastMemory warm(0.4 * seconds, 0.5 * seconds), last(0.9 * seconds, seconds);
  std::int64_t incomplete = 0, sets = 0;
  const Clock::time_point begin = Clock::now();
  const auto now_s = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  for (core::FrameIndex frame = 0; now_s() < seconds; ++frame) {
    const FrameSet set = rig.Read(frame);
    accounts.Add(set);
    ++sets;
    bool is_complete = true;
    for (const CameraFrame& camera : set.cameras) is_complete = is_complete && camera.stamp.has_value();
    incomplete += is_complete ? 0 : 1;
    for (Outage& outage : outages) {
      if (!outage.is_off && now_s() > outage.off_s) {
        farm.Switch(outage.camera, false);
        outage.is_off = true;
      } else if (outage.is_off && outage.on_at == Clock::time_point() && now_s() > outage.off_s + 2.0) {
        farm.Switch(outage.camera, true);
        outage.on_at = Clock::now();
      } else if (outage.on_at != Clock::time_point() && !outage.is_back &&
                 set.cameras[static_cast<std::size_t>(outage.camera)].stamp) {
        outage.is_back = true;
        back_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - outage.on_at).count());
        EXPECT_EQ(rig.states()[static_cast<std::size_t>(outage.camera)].report.exposure_us, 5000.0);
      }
    }
    warm.Look(now_s());
    last.Look(now_s());
  }
  const double grown_bytes = last.bytes() - warm.bytes();
  accounts.ExpectWhole();
  EXPECT_EQ(back_ms.size(), outages.size());

  using core::LossReason;
  std::printf("%.0f s, %ld sets, %ld of them lack a camera, %lu pictures judged\n", now_s(), sets, incomplete,
              accounts.judged());
  for (const LossReason reason :
       {LossReason::kNotSent, LossReason::kIncomplete, LossReason::kDamaged, LossReason::kCameraGone,
        LossReason::kNoRoom, LossReason::kPassedOver, LossReason::kUnpaired})
    std::printf("lost (%s): %lu\n", std::string(core::ToString(reason)).c_str(), accounts.lost(reason));
  const std::lock_guard lock(mutex);
  Print("sets decided after the last arrival", decision_ms);
  Print("back after it is switched on", back_ms);
  std::printf("memory from 40 to 50 %% of the time to the last tenth: %+.2f MB\n", grown_bytes / kMegabyte);
  ASSERT_TRUE(std::isfinite(grown_bytes)) << "memory was looked at in both parts of the time";
  EXPECT_LE(grown_bytes, kMegabyte);
}

}  // namespace
}  // namespace elbowroom::recon
