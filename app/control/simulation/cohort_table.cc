#include "app/control/simulation/cohort_table.h"

#include <fmt/format.h>

#include <optional>

#include "sessions/tables/csv_text.h"

namespace elbowroom::control {

std::string TruthCsv(std::span<const SimulatedTrial> trials) {
  const auto field = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  std::string csv =
      "session,participant,order,condition,task,frames,estimate_before_mm,needed_without_tools_mm,needed_mm,"
      "estimate_after_mm,pattern_s\n";
  for (const SimulatedTrial& trial : trials) {
    const core::TrialInfo& info = trial.setup.info;
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", sessions::Quoted(trial.file),
                       sessions::Quoted(info.participant), info.order, sessions::Quoted(info.condition),
                       sessions::Quoted(info.task), trial.frames, field(trial.truth.estimate_before_mm),
                       trial.truth.needed_without_tools_mm, trial.truth.needed_mm,
                       field(trial.truth.estimate_after_mm), field(trial.truth.pattern_s));
  }
  return csv;
}

}  // namespace elbowroom::control
