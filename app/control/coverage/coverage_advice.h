// What a rig lacks, and what to do about it, in plain words.
#pragma once

#include <string>
#include <vector>

#include "app/control/coverage/coverage_job.h"

namespace elbowroom::control {

// One line each: space that too few cameras see, space that the unseen policy loses, cameras on one side, a
// calibration that costs more than the pixels, parts that are worse off than the rest, and the next camera.
[[nodiscard]] std::vector<std::string> CoverageAdvice(const CoverageOutcome& outcome);

}  // namespace elbowroom::control
