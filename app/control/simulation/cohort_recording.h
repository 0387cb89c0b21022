// Records a simulated cohort as sessions, through the pipeline of every trial.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <vector>

#include "app/control/simulation/cohort.h"
#include "core/progress.h"

namespace elbowroom::control {

struct RecordedCohort {
  std::vector<SimulatedTrial> trials;
  std::vector<std::filesystem::path> sessions;  // one a trial
  std::filesystem::path truth;                  // truth.csv
  std::int64_t frames = 0;
  std::int64_t kept = 0;  // sessions that a run before had recorded
};

// PlanCohort, each trial before the demo's four cameras with noise of its own, several at once, into
// `folder`, which is made if need be; then truth.csv. A session that an earlier run with the same options
// recorded whole is kept; so a run that was stopped goes on. Its rows are a function of the options alone,
// but for recording id, begin and versions. Throws: core::Error{kFile}: a file of that name is there that
// isn't that session, and what can't be written; {kCancelled}: sessions that are whole stay. Thread: any;
// `progress` is called on several, one at a time.
[[nodiscard]] RecordedCohort RecordCohort(const CohortOptions& options, const std::filesystem::path& folder,
                                          const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
