#include "app/control/cameras/camera_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "app/control/cameras/camera_advice.h"
#include "app/control/cameras/light_check.h"
#include "app/control/cameras/timed_wait.h"
#include "core/error.h"
#include "recon/capture/camera_list.h"
#include "recon/capture/live_rig.h"
#include "recon/capture/rig_source.h"
#include "recon/rig_files/source_location.h"

namespace elbowroom::control {
namespace {

using Clock = std::chrono::steady_clock;

double MsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

// Looks are costly beside the copying of a picture, so only some pictures are looked at.
constexpr std::int64_t kFramesBetweenLooks = 10;

// What is measured of one camera while it runs.
struct Tally {
  std::int64_t frames = 0;
  std::int64_t unpaired = 0;
  std::map<core::LossReason, std::int64_t> losses;
  std::uint64_t first_number = 0, last_number = 0;
  Clock::time_point first_at, last_at;
  std::optional<recon::StampSource> stamps;
  std::vector<double> latency_ms, skew_ms;
  cv::Mat latest;     // not looked at yet; empty: all are
  cv::Mat looked_at;  // the last one that was
  double level_sum = 0.0, saturated_sum = 0.0, sharpness_sum = 0.0;
  std::int64_t looks = 0;

  void Add(const recon::CapturedPicture& picture) {
    if (frames++ == 0) {
      first_number = picture.number;
      first_at = picture.taken_at;
    }
    last_number = picture.number;
    last_at = picture.taken_at;
    stamps = picture.stamp_source;
    latency_ms.push_back(MsBetween(picture.taken_at, picture.arrived_at));
    latest = picture.image_bgr;
  }

  void Look(const cv::Mat& image_bgr) {
    cv::Mat grey, laplacian, at_limit;
    cv::cvtColor(image_bgr, grey, cv::COLOR_BGR2GRAY);
    cv::Laplacian(grey, laplacian, CV_32F);
    cv::Scalar mean, deviation;
    cv::meanStdDev(laplacian, mean, deviation);
    sharpness_sum += deviation[0] * deviation[0];
    level_sum += cv::mean(image_bgr.reshape(1))[0];
    cv::Mat channels[3];
    cv::split(image_bgr, channels);
    at_limit = cv::max(cv::max(channels[0], channels[1]), channels[2]) == 255;
    saturated_sum += static_cast<double>(cv::countNonZero(at_limit)) / static_cast<double>(image_bgr.total());
    ++looks;
  }
};

class Check {
 public:
  Check(const recon::RigFile& rig_file, const core::Progress& progress, const std::stop_token& stop)
      : tallies_(rig_file.rig.cameras.size()),
        light_(rig_file, progress, stop),
        rig_(rig_file, Taps(), stop) {
    // What came while the other cameras started doesn't count.
    const std::lock_guard lock(mutex_);
    for (Tally& tally : tallies_) tally = {};
    sets_ = incomplete_sets_ = 0;
    decision_ms_.clear();
    light_.Forget();
    begin_ = Clock::now();
  }

  void Run(double seconds, const core::Progress& progress, const std::stop_token& stop) {
    WaitSeconds(seconds, "checking the cameras, second", progress, stop, [this] {
      LookAtPictures();
      light_.Look();
      return false;
    });
    core::ThrowIfStopped(stop, "checking the cameras");
    seconds_ = MsBetween(begin_, Clock::now()) / 1000.0;
  }

  [[nodiscard]] RigHealth Health(const core::Rig& rig) {
    const std::vector<recon::CameraState> states = rig_.states();
    const std::lock_guard lock(mutex_);
    RigHealth health{{}, sets_, incomplete_sets_, core::SpreadOf(decision_ms_), seconds_, {}};
    for (core::CameraIndex i = 0; i < tallies_.size(); ++i) {
      const Tally& tally = tallies_[i];
      CameraHealth camera;
      camera.name = rig.cameras[i].name();
      camera.state = states[i];
      camera.frames = tally.frames;
      camera.unpaired = tally.unpaired;
      camera.losses = tally.losses;
      if (tally.last_number > tally.first_number) {
        camera.rate_hz = static_cast<double>(tally.last_number - tally.first_number) * 1000.0 /
                         MsBetween(tally.first_at, tally.last_at);
      }
      camera.latency_ms = core::SpreadOf(tally.latency_ms);
      camera.skew_ms = core::SpreadOf(tally.skew_ms);
      camera.stamps = tally.stamps;
      const auto looks = static_cast<double>(std::max<std::int64_t>(1, tally.looks));
      camera.mean_level = tally.level_sum / looks;
      camera.saturated_share = tally.saturated_sum / looks;
      camera.sharpness = tally.sharpness_sum / looks;
      camera.picture = (tally.latest.empty() ? tally.looked_at : tally.latest).clone();
      camera.light = light_.Report(i);
      health.cameras.push_back(std::move(camera));
    }
    if (!light_.trouble().empty()) health.warnings.push_back(light_.trouble());
    AddAdvice(&health);
    return health;
  }

 private:
  [[nodiscard]] recon::LiveTaps Taps() {
    recon::LiveTaps taps;
    taps.on_picture = [this](core::CameraIndex camera, const recon::CapturedPicture& picture) {
      light_.Keep(camera, picture);
      const std::lock_guard lock(mutex_);
      tallies_[camera].Add(picture);
    };
    taps.on_set = [this](const recon::DecidedSet& decided) {
      const std::lock_guard lock(mutex_);
      AddSet(decided);
    };
    return taps;
  }

  void AddSet(const recon::DecidedSet& decided) {
    ++sets_;
    Clock::time_point last = Clock::time_point::min();
    bool is_complete = true;
    for (core::CameraIndex i = 0; i < tallies_.size(); ++i) {
      const auto& picture = decided.set.pictures[i];
      is_complete = is_complete && picture.has_value();
      if (!picture) continue;
      last = std::max(last, picture->arrived_at);
      tallies_[i].skew_ms.push_back(std::abs(MsBetween(decided.set.taken_at, picture->taken_at)));
    }
    incomplete_sets_ += is_complete ? 0 : 1;
    decision_ms_.push_back(MsBetween(last, decided.decided_at));
    for (const core::PictureLoss& loss : decided.losses) {
      Tally& tally = tallies_[loss.camera];
      const auto count = static_cast<std::int64_t>(loss.count());
      if (loss.reason == core::LossReason::kUnpaired) {
        tally.unpaired += count;
      } else {
        tally.losses[loss.reason] += count;
      }
    }
  }

  // On the caller's thread, so that capture waits for nobody.
  void LookAtPictures() {
    for (Tally& tally : tallies_) {
      cv::Mat picture;
      {
        const std::lock_guard lock(mutex_);
        if (tally.frames < tally.looks * kFramesBetweenLooks || tally.latest.empty()) continue;
        picture = tally.looked_at = std::exchange(tally.latest, cv::Mat());
      }
      Tally look;
      look.Look(picture);
      const std::lock_guard lock(mutex_);
      tally.level_sum += look.level_sum;
      tally.saturated_sum += look.saturated_sum;
      tally.sharpness_sum += look.sharpness_sum;
      ++tally.looks;
    }
  }

  std::mutex mutex_;
  std::vector<Tally> tallies_;
  std::int64_t sets_ = 0, incomplete_sets_ = 0;
  std::vector<double> decision_ms_;
  Clock::time_point begin_;
  double seconds_ = 0.0;
  LightCheck light_;
  recon::LiveRig rig_;  // last: its threads use the others
};

}  // namespace

std::int64_t CameraHealth::lost() const {
  std::int64_t lost = 0;
  for (const auto& [reason, count] : losses) lost += count;
  return lost;
}

bool RigHealth::is_well() const {
  return warnings.empty() &&
         std::ranges::all_of(cameras, [](const CameraHealth& camera) { return camera.advice.empty(); });
}

void RequireLiveRig(const recon::RigFile& rig_file) {
  if (recon::IsLiveRig(rig_file)) return;
  throw core::Error(core::ErrorKind::kFormat,
                    fmt::format("rig '{}' has no live cameras: each camera's 'frames' must name one, as "
                                "\"v4l2:/dev/video0\", \"gige:NAME\" or \"rtsp://...\"",
                                rig_file.rig.name));
}

RigHealth CheckCameras(const recon::RigFile& rig_file, double seconds, const core::Progress& progress,
                       const std::stop_token& stop) {
  RequireLiveRig(rig_file);
  Check check(rig_file, progress, stop);
  check.Run(seconds, progress, stop);
  return check.Health(rig_file.rig);
}

std::vector<std::string> ListCameras(const std::stop_token& stop) { return recon::FindLiveCameras(stop); }

recon::RigFile UncalibratedRig(const std::vector<std::string>& cameras, int width_px, int height_px,
                               double rate_hz) {
  recon::RigFile rig_file;
  rig_file.is_calibrated = false;
  for (const std::string& camera : cameras) {
    const std::string location = camera.substr(0, camera.find(" ("));
    if (!recon::IsLive(location))
      throw core::Error(core::ErrorKind::kFormat,
                        fmt::format("'{}' is no live camera; name it as 'v4l2:/dev/video0', 'gige:NAME' or "
                                    "'rtsp://...'",
                                    location));
    rig_file.rig.cameras.push_back(
        recon::PlaceholderCamera(fmt::format("cam{}", rig_file.sources.size() + 1), width_px, height_px));
    rig_file.sources.emplace_back().frames = location;
    rig_file.sources.back().capture.rate_hz = rate_hz;
  }
  if (cameras.empty())
    throw core::Error(core::ErrorKind::kFormat,
                      "no camera was found; plug one in, or name a stream with --add rtsp://...");
  return rig_file;
}

}  // namespace elbowroom::control
