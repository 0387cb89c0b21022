// The table [head_camera] of HEAD.toml.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>

#include "recon/head_pose/head_camera.h"

namespace elbowroom::control {

// Nothing: the file has none. Throws: Error{kFormat} with file, line and key.
[[nodiscard]] std::optional<recon::HeadCamera> HeadCameraOf(const toml::table& root, const std::string& file);

}  // namespace elbowroom::control
