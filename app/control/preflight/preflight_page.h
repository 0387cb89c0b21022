// The preflight as a page that opens in any browser: every camera's picture, well or with what to do.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/control/cameras/camera_check.h"
#include "app/control/preflight/preflight.h"

namespace elbowroom::control {

// Writes preflight.html into `folder`, and returns its path. `rows`: what is to be said, in order; of them
// those that have a camera's name get its picture. Throws: Error{kFile}.
std::filesystem::path WritePreflightPage(const std::string& rig_name, const std::vector<PreflightRow>& rows,
                                         const RigHealth& health, const std::filesystem::path& folder);

}  // namespace elbowroom::control
