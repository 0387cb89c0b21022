// Footage of a rig's live cameras, recorded until enough or stopped.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"
#include "recon/recording/footage_recorder.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct CamerasRecorded {
  recon::FootageRecording footage;
  bool ended_early = false;           // the disk is full
  std::vector<std::string> warnings;  // a line each
};

// Records into `folder`, which doesn't exist or is empty, for so long; without `seconds` until a stop. A stop
// ends the recording in order at any time. Throws: as recon::LiveRig (a stop while the cameras start, too);
// Error{kFormat} for a rig that isn't live; Error{kFile} for the folder, and naming the camera whose video
// can't be written; those of the other cameras are whole then, but there is no RIG.yml.
[[nodiscard]] CamerasRecorded RecordCameras(const recon::RigFile& rig_file,
                                            const std::filesystem::path& folder,
                                            const std::optional<double>& seconds,
                                            const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
