#include "app/control/study_plan/plan_file.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "app/control/layout_editing/layout_edit.h"
#include "cad_import/layout/layout_fields.h"
#include "core/error.h"
#include "core/plain_text.h"
#include "core/system/configuration_file.h"
#include "core/system/file_sync.h"
#include "core/system/whole_file.h"
#include "sessions/tables/csv_text.h"

namespace elbowroom::control {
namespace {

namespace fs = std::filesystem;

std::string TrialTextOf(const PlannedTrial& trial, const fs::path& file) {
  std::string text = fmt::format("# Planned: one of {}'s trials. Its base says all else.\n",
                                 core::Blanked(trial.participant));
  const auto add = [&](const char* key, const cad_import::FieldValue& value) {
    text += fmt::format("{} = {}\n", key, cad_import::TomlOf(value));
  };
  add("base", FileBeside(file, trial.trial_file));
  add("participant", trial.participant);
  add("condition", trial.condition);
  text += fmt::format("order = {}\n", trial.order);
  if (!trial.block.empty()) add("block", trial.block);
  if (!trial.task.empty()) add("task", trial.task);
  return text;
}

// The plan's sources are worth more than its table.
void RequireNoSource(const fs::path& study, const std::vector<PlannedTrial>& trials, const fs::path& csv) {
  const auto is_csv = [&](const fs::path& source) {
    std::error_code unknown;
    return fs::equivalent(source, csv, unknown);
  };
  bool is_source = is_csv(study);
  for (const PlannedTrial& trial : trials) is_source = is_source || is_csv(trial.trial_file);
  if (is_source)
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("{}: the plan is made from this file; give its table another name", csv.string()));
}

// Whether it is there and says that; throws where it says something else.
bool IsThere(const fs::path& file, const std::string& text) {
  std::error_code unknown;
  if (!fs::exists(fs::symlink_status(file, unknown))) return false;
  const std::string name = file.string();
  if (core::ReadConfiguration(file, name, "trial file") == text) return true;
  throw core::Error(
      core::ErrorKind::kFile,
      fmt::format("{}: is there and says something else; move it away, or name another folder", name));
}

}  // namespace

void WritePlan(const StudyPlan& plan, const std::filesystem::path& csv) {
  const std::vector<PlannedTrial> trials = PlannedTrials(plan);
  RequireNoSource(plan.file, trials, csv);
  std::string text = "participant,order,condition,block,task,trial\n";
  for (const PlannedTrial& trial : trials)
    text += fmt::format("{},{},{},{},{},{}\n", sessions::Quoted(trial.participant), trial.order,
                        sessions::Quoted(trial.condition), sessions::Quoted(trial.block),
                        sessions::Quoted(trial.task), sessions::Quoted(trial.trial_file.string()));
  core::WriteWholeFile(csv, text);
}

std::vector<fs::path> WriteTrialFiles(const StudyPlan& plan, const fs::path& folder) {
  std::vector<fs::path> files;
  core::PendingFiles pending;
  core::MakeFolder(folder);
  for (const PlannedTrial& trial : PlannedTrials(plan)) {
    const fs::path& file =
        files.emplace_back(folder / fmt::format("{}-{}.toml", trial.participant, trial.order));
    const std::string text = TrialTextOf(trial, file);
    if (!IsThere(file, text)) pending.Write(file, text);
  }
  pending.RenameAll();
  return files;
}

}  // namespace elbowroom::control
