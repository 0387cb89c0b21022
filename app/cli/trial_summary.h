// How a trial went, for people and for programs.
#pragma once

#include "app/cli/command.h"
#include "app/control/trial_runner.h"

namespace elbowroom::cli {

[[nodiscard]] CommandResult SummaryOf(const control::TrialOutcome& outcome, const core::Layout& layout,
                                      const std::filesystem::path& session);

}  // namespace elbowroom::cli
