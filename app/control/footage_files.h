// The files of a trial's footage, as its session names them.
#pragma once

#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "core/session.h"

namespace elbowroom::control {

// Every file of the footage's folder with its size and checksum: RIG.yml first, then by name. `file` is
// relative to the folder above. Reads all of them. Throws: core::Error{kFile}.
[[nodiscard]] std::vector<core::FootageFile> FootageFilesIn(const std::filesystem::path& folder,
                                                            const core::Progress& progress);

}  // namespace elbowroom::control
