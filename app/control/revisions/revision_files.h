// The files of a sweep against revisions: revisions.csv, revisions.html and revisions.pdf.
#pragma once

#include <filesystem>
#include <stop_token>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"
#include "core/progress.h"

namespace elbowroom::control {

// In `folder`, which is made if it isn't there; all or none. revisions.csv has a line for each changed part
// of each revision in each session at each step. Throws: core::Error{kFile, kCancelled}; PreconditionError
// for a sweep without revisions.
[[nodiscard]] std::vector<std::filesystem::path> WriteRevisions(const SpacingRange& range,
                                                                const SpacingSweep& sweep,
                                                                const std::filesystem::path& folder,
                                                                const core::Progress& progress,
                                                                const std::stop_token& stop);

}  // namespace elbowroom::control
