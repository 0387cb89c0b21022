// A study's plan as a table, and as trial files.
#pragma once

#include <filesystem>
#include <vector>

#include "app/control/study_plan/study_plan.h"

namespace elbowroom::control {

// A line for each trial: participant, order, condition, block, task and the trial's file. Whole or not at
// all; a file that is there is replaced, unless the plan is made from it. Throws: core::Error{kFile}.
void WritePlan(const StudyPlan& plan, const std::filesystem::path& csv);

// A trial file for each trial, PARTICIPANT-ORDER.toml, in the order of PlannedTrials: it names the plan's
// trial file as its base, and says participant, condition, order, block and task itself. The folder is made
// if it isn't there. All or none; a file that says the same already stays as it is. Throws:
// core::Error{kFile}, also for a file that says something else.
std::vector<std::filesystem::path> WriteTrialFiles(const StudyPlan& plan,
                                                   const std::filesystem::path& folder);

}  // namespace elbowroom::control
