// Simulated participants of the paper's payload spacing task.
#pragma once

#include <vector>

#include "app/control/simulation/cohort.h"

namespace elbowroom::control {

// A trial each. One of each four has a cable that is stiff enough to be fed by hand (the paper's participant
// 1), the others take tongs. `options` is valid.
[[nodiscard]] std::vector<SimulatedTrial> PlanPayloadCohort(const CohortOptions& options);

}  // namespace elbowroom::control
