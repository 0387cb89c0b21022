#include "app/control/simulation/cohort.h"

#include "app/control/simulation/block_cohort.h"
#include "app/control/simulation/payload_cohort.h"
#include "core/error.h"

namespace elbowroom::control {

std::optional<CohortTask> ParseCohortTask(std::string_view text) {
  for (const CohortTask task : kCohortTasks)
    if (text == ToString(task)) return task;
  return std::nullopt;
}

std::string_view ToString(CohortTask task) {
  switch (task) {
    case CohortTask::kPayload:
      return "payload";
    case CohortTask::kBlocks:
      return "blocks";
  }
  return "";
}

CohortOptions CohortOptions::Of(CohortTask task) {
  CohortOptions options;
  options.task = task;
  if (task == CohortTask::kBlocks) {
    options.participants = 12;
    options.seconds = 4.0;
    options.frame_rate_hz = 5.0;
  }
  return options;
}

void CohortOptions::Validate() const {
  core::Require(participants >= 1 && participants <= 10'000, "participants lies between 1 and 10000");
  core::Require(seconds >= 0.5 && seconds <= 600.0, "seconds lies between 0.5 and 600");
  core::Require(frame_rate_hz >= 1.0 && frame_rate_hz <= 60.0, "frame_rate_hz lies between 1 and 60");
}

std::vector<SimulatedTrial> PlanCohort(const CohortOptions& options) {
  options.Validate();
  switch (options.task) {
    case CohortTask::kPayload:
      return PlanPayloadCohort(options);
    case CohortTask::kBlocks:
      return PlanBlockCohort(options);
  }
  return {};
}

}  // namespace elbowroom::control
