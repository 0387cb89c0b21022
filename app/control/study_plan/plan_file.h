// A study's plan as a table.
#pragma once

#include <filesystem>

#include "app/control/study_plan/study_plan.h"

namespace elbowroom::control {

// A line for each trial: participant, order, condition, block, task and the trial's file. Whole or not at
// all; a file that is there is replaced. Throws: core::Error{kFile}.
void WritePlan(const StudyPlan& plan, const std::filesystem::path& csv);

}  // namespace elbowroom::control
