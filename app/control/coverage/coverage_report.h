// A rig's coverage as a page, pictures and a volume.
#pragma once

#include <filesystem>
#include <vector>

#include "app/control/coverage/coverage_job.h"

namespace elbowroom::control {

// Writes coverage.html, which needs no other file, an SVG of each quantity, and coverage.glb into `folder`,
// all of them or none. Returns their paths. Throws: Error{kFile} naming what can't be written.
std::vector<std::filesystem::path> WriteCoverage(const CoverageOutcome& outcome,
                                                 const std::filesystem::path& folder);

}  // namespace elbowroom::control
