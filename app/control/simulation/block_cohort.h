// Simulated participants of the paper's block-design task.
#pragma once

#include <string>
#include <vector>

#include "app/control/simulation/cohort.h"

namespace elbowroom::control {

// What is varied, of what this system can run: the paper's real space, its hybrid environment (generic hands)
// and its visually faithful one. The purely virtual one needs tracked gloves.
inline constexpr const char* kRealSpace = "real";
inline constexpr const char* kGenericHands = "generic hands";
inline constexpr const char* kFaithfulHands = "faithful hands";

// As the paper's procedure: each pattern is a trial. In real space three small ones and three large ones to
// practise, and as many timed; then in one hybrid environment two of each. Of each two participants, one has
// generic hands. `options` is valid.
[[nodiscard]] std::vector<SimulatedTrial> PlanBlockCohort(const CohortOptions& options);

}  // namespace elbowroom::control
