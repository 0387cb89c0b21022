// elbowroom plan STUDY.toml: which trial each participant of a study does when.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/control/study_plan/plan_file.h"
#include "app/control/study_plan/study_plan.h"

namespace elbowroom::cli {
namespace {

struct PlanOptions {
  std::filesystem::path study;
  std::filesystem::path csv;     // empty: none is written
  std::filesystem::path trials;  // folder of trial files; empty: none are written
};

std::string UnevenRemark(const control::StudyPlan& plan) {
  const std::size_t block = control::BlockSizeOf(plan), participants = plan.participants.size();
  if (participants % block == 0) return "";
  const std::size_t fewer = participants / block * block;
  return fmt::format(
      "{} participants aren't a multiple of {}: some {} have one more than others; {}{} would be even",
      participants, block, plan.design == control::StudyDesign::kBetween ? "conditions" : "orders",
      fewer > 0 ? fmt::format("{} or ", fewer) : "", fewer + block);
}

CommandResult Run(const PlanOptions& options) {
  const control::StudyPlan plan = control::ReadStudyPlan(options.study);
  CommandResult result;
  result.hint = UnevenRemark(plan);
  result.json = {{"study", plan.name},
                 {"seed", plan.seed},
                 {"design", plan.design == control::StudyDesign::kBetween ? "between" : "within"},
                 {"participants", plan.participants.size()}};
  result.json["trials"] = nlohmann::json::array();
  std::map<std::string, std::set<std::string>> participants_of;  // by condition
  std::string participant;
  for (const control::PlannedTrial& trial : control::PlannedTrials(plan)) {
    participants_of[trial.condition].insert(trial.participant);
    result.json["trials"].push_back({{"participant", trial.participant},
                                     {"order", trial.order},
                                     {"condition", trial.condition},
                                     {"block", trial.block},
                                     {"task", trial.task},
                                     {"trial", trial.trial_file.string()}});
    if (trial.participant != participant) {
      participant = trial.participant;
      result.text += fmt::format("{}{}:", result.text.empty() ? "" : "\n", participant);
    }
    result.text += fmt::format(" {}. {}{}", trial.order, trial.condition,
                               trial.task.empty() ? "" : fmt::format(" ({})", trial.task));
  }
  result.json["conditions"] = nlohmann::json::array();
  for (const control::PlannedCondition& condition : plan.conditions)
    result.json["conditions"].push_back(
        {{"condition", condition.name}, {"participants", participants_of[condition.name].size()}});
  result.json["files"] = nlohmann::json::array();
  std::vector<std::filesystem::path> files;
  if (!options.trials.empty()) files = control::WriteTrialFiles(plan, options.trials);
  for (std::size_t i = 0; i < files.size(); ++i) result.json["trials"][i]["file"] = files[i].string();
  if (!options.csv.empty()) {
    control::WritePlan(plan, options.csv);
    files.push_back(options.csv);
    result.text += "\n" + options.csv.string();
  }
  for (const std::filesystem::path& file : files) result.json["files"].push_back(file.string());
  if (!options.trials.empty())
    result.text += fmt::format("\n{}: a trial file for each, such as {}", options.trials.string(),
                               files.front().filename().string());
  return result;
}

}  // namespace

void AddPlanCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("plan", "a study's plan: which trial each participant does when, in balanced order");
  auto options = std::make_shared<PlanOptions>();
  command->add_option("STUDY", options->study, "the study (STUDY.toml)")->required();
  command->add_option("--out", options->csv, "the plan as a table (.csv); replaced if it is there");
  command->add_option(
      "--trials", options->trials,
      "folder for a trial file for each planned trial, such as P01-1.toml, which 'trial run' "
      "and the window take; made if needed, and no file that says something else is replaced");
  command->callback([=] { choice->action = [=](const CommandContext&) { return Run(*options); }; });
}

}  // namespace elbowroom::cli
