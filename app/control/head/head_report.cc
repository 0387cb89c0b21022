#include "app/control/head/head_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <variant>

#include "app/control/head/cap_watch.h"
#include "app/control/head/head_tracker.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

constexpr std::chrono::milliseconds kTellsEvery{250};

// Mean and spread of places, without keeping them (Welford's method).
class PlaceSpread {
 public:
  void Add(const Vector3d& place) {
    ++count_;
    const Vector3d off = place - mean_;
    mean_ += off / static_cast<double>(count_);
    squares_ += off.dot(place - mean_);
  }
  [[nodiscard]] std::optional<double> Rms() const {
    if (count_ < 2) return std::nullopt;
    return std::sqrt(squares_ / static_cast<double>(count_));
  }

 private:
  std::int64_t count_ = 0;
  Vector3d mean_ = Vector3d::Zero();
  double squares_ = 0.0;
};

std::optional<double> MedianOf(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double SecondsSince(HeadClock::time_point begin) {
  return std::chrono::duration<double>(HeadClock::now() - begin).count();
}

bool IsRefused(const HeadReport& report) {
  return report.headset && report.headset->phase == recon::HeadsetPhase::kRefused &&
         report.counts.accepted == 0;
}

std::string Turned(double angle_deg, const char* if_positive, const char* if_negative) {
  return fmt::format("{:.1f} {}", std::abs(angle_deg), angle_deg < -0.05 ? if_negative : if_positive);
}

}  // namespace

double HeadReport::poses_per_s() const {
  return seconds > 0.0 ? static_cast<double>(counts.accepted) / seconds : 0.0;
}

HeadReport WatchPackets(const HeadSettings& settings, double seconds, const std::function<void(int)>& on_port,
                        const OnHeadReport& on_report, const std::stop_token& stop) {
  using recon::HeadSource;
  core::Require(settings.source != HeadSource::kFixed && settings.source != HeadSource::kCap,
                "the source sends packets, or is a headset");
  std::mutex mutex;
  std::condition_variable_any came;
  bool has_news = false;
  HeadTracker tracker(settings, std::nullopt, [&](const HeadState&) {
    const std::lock_guard lock(mutex);
    has_news = true;
    came.notify_all();
  });
  if (on_port && tracker.port()) on_port(*tracker.port());
  PlaceSpread spread;
  HeadReport report;
  const auto begin = HeadClock::now();
  auto told_at = begin;
  while (!stop.stop_requested() && SecondsSince(begin) < seconds && !IsRefused(report)) {
    {
      std::unique_lock lock(mutex);
      (void)came.wait_for(lock, stop, kTellsEvery, [&] { return has_news; });
      if (std::exchange(has_news, false)) {
        report.last = tracker.state().pose;
        if (report.last) spread.Add(report.last->world_from_head.translation_mm);
      }
    }
    report.seconds = SecondsSince(begin);
    report.counts = tracker.counts();
    report.headset = tracker.headset();
    report.spread_mm = spread.Rms();
    if (!on_report || HeadClock::now() - told_at < kTellsEvery) continue;
    told_at = HeadClock::now();
    on_report(report);
  }
  return report;
}

HeadReport WatchCap(const HeadSettings& settings, recon::FrameSetSource& source, double seconds,
                    const OnHeadReport& on_report, const std::stop_token& stop) {
  const CapWatch watch(settings.cap, source.rig());
  HeadReport report;
  PlaceSpread spread;
  std::vector<double> sigmas_mm, sigmas_rad, cameras;
  auto told_at = HeadClock::now();
  for (core::FrameIndex frame = 0; !stop.stop_requested(); ++frame) {
    const auto frames = source.TryRead(frame, stop);
    if (!frames || frames->time_s > seconds) break;
    report.seconds = frames->time_s;
    const auto found = watch.Find(*frames);
    if (const auto* pose = std::get_if<recon::CapPose>(&found)) {
      ++report.counts.accepted;
      report.last = recon::HeadPose{pose->world_from_head, frames->taken_at.value_or(HeadClock::now()),
                                    recon::HeadSource::kCap, pose->sigma_mm(), pose->sigma_rad()};
      spread.Add(pose->world_from_head.translation_mm);
      sigmas_mm.push_back(pose->sigma_mm());
      sigmas_rad.push_back(pose->sigma_rad());
      cameras.push_back(pose->cameras);
    } else {
      ++report.counts.refused[static_cast<std::size_t>(PoseFault::kNotSeen)];
      ++report.not_seen[std::string(recon::ToString(std::get<recon::NoCapPose>(found)))];
    }
    if (!on_report || HeadClock::now() - told_at < kTellsEvery) continue;
    told_at = HeadClock::now();
    report.spread_mm = spread.Rms();
    on_report(report);
  }
  report.spread_mm = spread.Rms();
  report.sigma_mm = MedianOf(std::move(sigmas_mm));
  report.sigma_rad = MedianOf(std::move(sigmas_rad));
  report.cameras = MedianOf(std::move(cameras));
  return report;
}

std::string HeadText(const core::RigidTransform& world_from_head) {
  const TrackerReading reading = ReadingOf(world_from_head);
  const Vector3d& p = reading.position_mm;
  return fmt::format("eyes at x {:.0f}, y {:.0f}, z {:.0f} mm; looks {}, {}; tilted {}", p.x(), p.y(), p.z(),
                     Turned(reading.yaw_deg, "degrees right", "degrees left"),
                     Turned(reading.pitch_deg, "up", "down"),
                     Turned(reading.roll_deg, "to the right shoulder", "to the left shoulder"));
}

}  // namespace elbowroom::control
