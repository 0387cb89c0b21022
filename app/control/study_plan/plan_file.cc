#include "app/control/study_plan/plan_file.h"

#include <fmt/format.h>

#include <string>

#include "core/system/whole_file.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::control {

void WritePlan(const StudyPlan& plan, const std::filesystem::path& csv) {
  std::string text = "participant,order,condition,block,task,trial\n";
  for (const PlannedTrial& trial : PlannedTrials(plan))
    text += fmt::format("{},{},{},{},{},{}\n", sessions::Quoted(trial.participant), trial.order,
                        sessions::Quoted(trial.condition), sessions::Quoted(trial.block),
                        sessions::Quoted(trial.task), sessions::Quoted(trial.trial_file.string()));
  core::WriteWholeFile(csv, text);
}

}  // namespace elbowroom::control
