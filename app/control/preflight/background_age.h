// When a rig's background was taken, by its files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct BackgroundFiles {
  // The first camera whose background is named nowhere, or whose files aren't there; "": all are there.
  std::string lacking_camera;
  // When the oldest of the cameras' backgrounds was written last. Nothing: no camera has one (ready masks).
  std::optional<std::filesystem::file_time_type> written_at;
};

[[nodiscard]] BackgroundFiles FindBackgroundFiles(const recon::RigFile& rig_file);

}  // namespace elbowroom::control
