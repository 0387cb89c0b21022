#include "app/control/cameras/camera_recording.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>

#include "app/control/cameras/camera_check.h"
#include "core/error.h"
#include "recon/capture/live_rig.h"

namespace elbowroom::control {
namespace {

using RecordingClock = std::chrono::steady_clock;

void WaitForEnd(const recon::FootageRecorder& recorder, const std::optional<double>& seconds,
                const core::Progress& progress, const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kBetweenReports{100};
  std::mutex mutex;
  std::condition_variable_any wakes;
  const RecordingClock::time_point begin = RecordingClock::now();
  const std::int64_t whole = seconds ? static_cast<std::int64_t>(std::ceil(*seconds)) : 0;
  while (!stop.stop_requested() && !recorder.has_ended()) {
    const std::chrono::duration<double> gone = RecordingClock::now() - begin;
    if (seconds && gone.count() >= *seconds) return;
    progress.Report(static_cast<std::int64_t>(gone.count()), whole, "recording, second");
    auto until = RecordingClock::now() + kBetweenReports;
    if (seconds) {
      const auto left = std::chrono::duration<double>(*seconds) - gone;
      until = std::min(until, RecordingClock::now() + std::chrono::ceil<RecordingClock::duration>(left));
    }
    std::unique_lock lock(mutex);
    wakes.wait_until(lock, stop, until, [] { return false; });
  }
}

}  // namespace

CamerasRecorded RecordCameras(const recon::RigFile& rig_file, const std::filesystem::path& folder,
                              const std::optional<double>& seconds, const core::Progress& progress,
                              const std::stop_token& stop) {
  RequireLiveRig(rig_file);
  recon::RequireEmptyFolder(folder);
  recon::FootageRecorder recorder(rig_file);
  recon::LiveRig rig(rig_file, recorder.Taps(), stop);
  recorder.Begin(folder);
  WaitForEnd(recorder, seconds, progress, stop);
  CamerasRecorded recorded;
  recorded.ended_early = recorder.has_ended();
  const std::vector<recon::CameraState> states = rig.states();
  recorded.footage = recorder.End();
  recorded.warnings = recorded.footage.Troubles();
  if (recorded.footage.rig_file.empty()) {
    throw core::Error(core::ErrorKind::kFile, fmt::format("the recording in '{}' is incomplete: {}",
                                                          folder.string(), recorded.warnings.front()));
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].presence != recon::CameraPresence::kGone) continue;
    recorded.warnings.push_back(fmt::format("camera '{}' was gone at the end: {}",
                                            rig_file.rig.cameras[i].name(), states[i].trouble));
  }
  return recorded;
}

}  // namespace elbowroom::control
