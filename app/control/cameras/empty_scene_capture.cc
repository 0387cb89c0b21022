#include "app/control/cameras/empty_scene_capture.h"

#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "app/control/cameras/timed_wait.h"
#include "core/error.h"
#include "recon/capture/live_rig.h"

namespace elbowroom::control {
namespace {

using CaptureTime = recon::CaptureClock::time_point;

class PictureCapture {
 public:
  PictureCapture(const recon::RigFile& rig_file, const CaptureSpan& span, const std::stop_token& stop)
      : span_(span),
        pictures_(rig_file.rig.cameras.size()),
        next_part_(rig_file.rig.cameras.size(), 0),
        rig_(rig_file, Taps(), stop) {}

  [[nodiscard]] std::vector<std::vector<recon::TimedPicture>> Run(const core::Progress& progress,
                                                                  const std::stop_token& stop) {
    Wait(span_.countdown_s, "leave the cameras' view; seconds waited:", progress, stop);
    {
      const std::lock_guard lock(mutex_);
      begin_ = recon::CaptureClock::now();
    }
    // Pictures of the last moment are still on their way then.
    constexpr double kOnTheirWayS = 0.25;
    Wait(span_.seconds + kOnTheirWayS, "taking the background, second", progress, stop);
    const std::lock_guard lock(mutex_);
    begin_.reset();
    return std::move(pictures_);
  }

 private:
  [[nodiscard]] recon::LiveTaps Taps() {
    recon::LiveTaps taps;
    taps.on_picture = [this](core::CameraIndex camera, const recon::CapturedPicture& picture) {
      const std::lock_guard lock(mutex_);
      Keep(camera, picture);
    };
    return taps;
  }

  void Keep(core::CameraIndex camera, const recon::CapturedPicture& picture) {
    if (!begin_) return;
    const double time_s = std::chrono::duration<double>(picture.taken_at - *begin_).count();
    if (time_s < 0.0 || time_s >= span_.seconds) return;
    const int part = static_cast<int>(std::floor(time_s / span_.seconds * span_.most_pictures));
    if (part < next_part_[camera]) return;
    next_part_[camera] = part + 1;
    pictures_[camera].push_back({picture.image_bgr, time_s});
  }

  static void Wait(double seconds, const std::string& what, const core::Progress& progress,
                   const std::stop_token& stop) {
    WaitSeconds(seconds, what, progress, stop, [] { return false; });
    core::ThrowIfStopped(stop, "taking the background");
  }

  CaptureSpan span_;
  std::mutex mutex_;
  std::optional<CaptureTime> begin_;  // nothing: pictures aren't kept
  std::vector<std::vector<recon::TimedPicture>> pictures_;
  std::vector<int> next_part_;  // of the time, that a picture is wanted of
  recon::LiveRig rig_;          // last: its threads use the others
};

}  // namespace

std::vector<std::vector<recon::TimedPicture>> CapturePictures(const recon::RigFile& rig_file,
                                                              const CaptureSpan& span,
                                                              const core::Progress& progress,
                                                              const std::stop_token& stop) {
  return PictureCapture(rig_file, span, stop).Run(progress, stop);
}

}  // namespace elbowroom::control
