// Cameras in the TOML files of anipose and Caliscope.
#pragma once

#include <string>
#include <string_view>

#include "recon/rig_files/foreign_rig.h"

namespace elbowroom::control {

// Tables with a `matrix`: [cam_0] ... of anipose, [cameras.0] ... of Caliscope. Cameras that Caliscope
// ignores are left out, with a warning. The format is told by the tables' keys. `file` begins the messages.
// Throws: Error{kFormat} naming file, line and key.
[[nodiscard]] recon::ForeignRig ParseForeignToml(std::string_view text, const std::string& file);

}  // namespace elbowroom::control
