// elbowroom simulate [payload|blocks] --out DIR: sessions of simulated participants, of whom it is known what
// they need.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/options/command.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/control/simulation/cohort.h"
#include "app/control/simulation/cohort_recording.h"

namespace elbowroom::cli {
namespace {

struct SimulateOptions {
  control::CohortTask task = control::CohortTask::kPayload;
  std::optional<int> participants;
  std::uint64_t seed = 1;
  std::optional<double> seconds;
  std::optional<double> frame_rate_hz;
  std::filesystem::path folder;
};

nlohmann::json TrialJson(const control::SimulatedTrial& trial, const std::filesystem::path& session) {
  const core::TrialInfo& info = trial.setup.info;
  return {{"session", session.string()},
          {"participant", info.participant},
          {"order", info.order},
          {"condition", info.condition},
          {"task", info.task},
          {"frames", trial.frames},
          {"estimate_before_mm", OrNull(trial.truth.estimate_before_mm)},
          {"needed_without_tools_mm", trial.truth.needed_without_tools_mm},
          {"needed_mm", trial.truth.needed_mm},
          {"estimate_after_mm", OrNull(trial.truth.estimate_after_mm)},
          {"pattern_s", OrNull(trial.truth.pattern_s)}};
}

CommandResult Run(const SimulateOptions& chosen, const CommandContext& context) {
  control::CohortOptions options = control::CohortOptions::Of(chosen.task);
  options.participants = chosen.participants.value_or(options.participants);
  options.seed = chosen.seed;
  options.seconds = chosen.seconds.value_or(options.seconds);
  options.frame_rate_hz = chosen.frame_rate_hz.value_or(options.frame_rate_hz);
  const control::RecordedCohort cohort =
      control::RecordCohort(options, chosen.folder, context.progress, context.stop);
  CommandResult result;
  result.json = {{"task", control::ToString(options.task)},
                 {"seed", options.seed},
                 {"seconds", options.seconds},
                 {"frame_rate_hz", options.frame_rate_hz},
                 {"participants", options.participants},
                 {"sessions", cohort.sessions.size()},
                 {"sessions_from_before", cohort.kept},
                 {"frames", cohort.frames},
                 {"truth", cohort.truth.string()}};
  result.json["trials"] = nlohmann::json::array();
  result.json["files"] = nlohmann::json::array();
  for (std::size_t i = 0; i < cohort.trials.size(); ++i) {
    result.json["trials"].push_back(TrialJson(cohort.trials[i], cohort.sessions[i]));
    result.json["files"].push_back(cohort.sessions[i].string());
  }
  result.json["files"].push_back(cohort.truth.string());
  result.text =
      fmt::format("{} simulated sessions of {} participants, {} frames, in '{}'", cohort.sessions.size(),
                  options.participants, cohort.frames, chosen.folder.string());
  if (cohort.kept > 0) result.text += fmt::format("\n{} of them were there from before", cohort.kept);
  result.text += fmt::format("\nwhat is known of them: {}", cohort.truth.string());
  return result;
}

}  // namespace

void AddSimulateCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand(
      "simulate",
      "sessions of simulated participants, with what each needs: to try a study before it begins");
  auto options = std::make_shared<SimulateOptions>();
  command
      ->add_option_function<std::string>(
          "TASK", [options](const std::string& text) { options->task = *control::ParseCohortTask(text); },
          "payload: the paper's payload spacing task; blocks: its block-design task, in real space and with "
          "generic or faithful hands")
      ->check(CLI::IsMember({"payload", "blocks"}))
      ->default_str("payload");
  command
      ->add_option("--out", options->folder,
                   "folder for the sessions (P01.db, ...) and truth.csv; made if needed. Sessions that an "
                   "earlier run with the same options recorded are kept")
      ->required();
  command->add_option("--participants", options->participants, "how many (default: payload 4, blocks 12)")
      ->check(CLI::Range(1, 10'000));
  command->add_option("--seed", options->seed, "the same seed gives the same motion again")
      ->check(CLI::NonNegativeNumber)
      ->default_str("1");
  command
      ->add_option("--seconds", options->seconds,
                   "how long a participant of usual speed takes, for the payload task (default: 16) or for a "
                   "timed 2 x 2 pattern in real space (default: 4)")
      ->check(NumberWithin(0.5, 600.0));
  command->add_option("--rate", options->frame_rate_hz, "frames a second (default: payload 15, blocks 5)")
      ->check(NumberWithin(1.0, 60.0));
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*options, context); }; });
}

}  // namespace elbowroom::cli
