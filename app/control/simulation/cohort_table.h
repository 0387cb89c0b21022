// What is known of a cohort, as a table.
#pragma once

#include <span>
#include <string>

#include "app/control/simulation/cohort.h"

namespace elbowroom::control {

// A line for each trial; what isn't known is empty.
[[nodiscard]] std::string TruthCsv(std::span<const SimulatedTrial> trials);

}  // namespace elbowroom::control
