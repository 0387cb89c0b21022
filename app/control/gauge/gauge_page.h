// The page of a gauge.
#pragma once

#include <filesystem>
#include <string>

#include "app/control/gauge/gauge_job.h"

namespace elbowroom::control {

// Writes gauge.html, whole or not at all, and returns its path. Throws: Error{kFile}.
std::filesystem::path WriteGaugePage(const core::Rig& rig, const GaugeOutcome& outcome,
                                     const std::filesystem::path& folder);

}  // namespace elbowroom::control
