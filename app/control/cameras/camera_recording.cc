#include "app/control/cameras/camera_recording.h"

#include <fmt/format.h>

#include "app/control/cameras/camera_check.h"
#include "app/control/cameras/timed_wait.h"
#include "core/error.h"
#include "recon/capture/live_rig.h"

namespace elbowroom::control {

CamerasRecorded RecordCameras(const recon::RigFile& rig_file, const std::filesystem::path& folder,
                              const std::optional<double>& seconds, const core::Progress& progress,
                              const std::stop_token& stop) {
  RequireLiveRig(rig_file);
  recon::RequireEmptyFolder(folder);
  recon::FootageRecorder recorder(rig_file);
  recon::LiveRig rig(rig_file, recorder.Taps(), stop);
  recorder.Begin(folder);
  WaitSeconds(seconds, "recording, second", progress, stop, [&] { return recorder.has_ended(); });
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
