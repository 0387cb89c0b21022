// elbowroom trial run TRIAL.toml --session S.db: a trial on recorded footage.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/frame_range_option.h"
#include "app/cli/trial_summary.h"
#include "app/control/trial_runner.h"
#include "app/control/trial_setup.h"

namespace elbowroom::cli {
namespace {

struct TrialRunOptions {
  std::filesystem::path trial_file;
  std::filesystem::path session;
  bool headless = false;
  control::FrameRange frames;
};

CommandResult RunHeadless(const TrialRunOptions& options, const CommandContext& context) {
  const control::TrialSetup setup = control::ReadTrialFile(options.trial_file, context.stop);
  control::TrialOptions trial;
  trial.session = options.session;
  trial.frames = options.frames;
  trial.progress = context.progress;
  RecordingLog log(context);
  trial.on_recording = [&](const sessions::RecordingNews& news) { log.Print(news); };
  control::TrialControls controls;
  const control::TrialOutcome outcome = control::RunTrial(setup, trial, controls, context.stop);
  CommandResult result = SummaryOf(outcome, setup.layout);
  std::vector<std::string> warnings = setup.warnings;
  std::ranges::copy(setup.source->Warnings(), std::back_inserter(warnings));
  std::ranges::copy(outcome.light_advice, std::back_inserter(warnings));
  for (const std::string& warning : warnings) result.json["warnings"].push_back(warning);
  for (const std::string& warning : warnings) result.text += "\nwarning: " + warning;
  log.AddTo(&result);
  return result;
}

}  // namespace

void AddTrialCommand(CLI::App& app, Choice* choice) {
  CLI::App* trial = app.add_subcommand("trial", "run trials");
  trial->require_subcommand(1);
  CLI::App* command = trial->add_subcommand("run", "run a trial and record it as a session");
  auto options = std::make_shared<TrialRunOptions>();
  command->add_option("TRIAL", options->trial_file, "the trial (TRIAL.toml)")->required();
  command->add_option("--session", options->session, "session file to record; must not exist yet")
      ->required();
  command->add_flag("--headless", options->headless, "no window, as fast as it goes");
  AddFrameRangeOption(*command, &options->frames);
  command->callback([=] {
    if (options->headless) {
      choice->action = [=](const CommandContext& context) { return RunHeadless(*options, context); };
    } else {
      choice->console = ConsoleRequest{options->trial_file, false, options->session, {}};
    }
  });
}

}  // namespace elbowroom::cli
