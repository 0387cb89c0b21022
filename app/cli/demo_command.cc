// elbowroom demo: the paper's payload task, simulated, from camera frames to the report.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/trial_summary.h"
#include "app/control/demo_trial.h"
#include "app/control/report/session_report.h"
#include "core/error.h"
#include "core/system/file_sync.h"

namespace elbowroom::cli {
namespace {

struct DemoOptions {
  std::filesystem::path out = "out";
  bool headless = false;
  WindowPictureRequest picture;  // without a file: none
};

CommandResult RunHeadless(const DemoOptions& options, const CommandContext& context) {
  core::MakeFolder(options.out);
  const control::TrialSetup setup = control::MakeDemoTrial(control::DemoPlay::kOnce);
  control::TrialOptions trial;
  trial.session = options.out / "session.db";
  trial.progress = context.progress;
  // view.png shows the frame with the most contact points.
  control::SharedFrameResult shown;
  std::int64_t most_points = -1;
  trial.on_frame = [&](const control::SharedFrameResult& result, const control::RecordedFrames&) {
    std::int64_t points = 0;
    for (const core::PartContact& contact : result->record.contacts) points += contact.contact_point_count;
    if (points <= most_points) return;
    most_points = points;
    shown = result;
  };
  RecordingLog log(context);
  trial.on_recording = [&](const sessions::RecordingNews& news) { log.Print(news); };
  control::TrialControls controls;
  const control::TrialOutcome outcome = control::RunTrial(setup, trial, controls, context.stop);
  try {
    if (shown) control::WriteFramePicture(*shown, options.out / "view.png", 1200, 800);
    control::WriteSessionReport(outcome.session, options.out, context.progress, context.stop);
  } catch (const core::Error& error) {
    throw core::Error(error.kind(), fmt::format("{}; all {} frames are in '{}', for `elbowroom report`",
                                                error.what(), outcome.frames, outcome.session.string()));
  }
  CommandResult result = SummaryOf(outcome, setup.layout);
  result.text += fmt::format("\nreport: {}\npicture: {}", (options.out / "report.html").string(),
                             (options.out / "view.png").string());
  result.json["report"] = (options.out / "report.html").string();
  result.json["view"] = (options.out / "view.png").string();
  log.AddTo(&result);
  return result;
}

}  // namespace

void AddDemoCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("demo", "simulated rig, PMT / payload A trial: session.db, report.html, view.png");
  auto options = std::make_shared<DemoOptions>();
  command->add_option("--out", options->out, "folder for what the demo writes (default: out)");
  command->add_flag("--headless", options->headless,
                    "no window: play the task at 140 and 240 mm, then write the report");
  CLI::Option* picture = command->add_option("--picture", options->picture.png,
                                             "write a picture of the window as PNG, then close it");
  command->add_option("--after", options->picture.after_s, "seconds of the trial before the picture")
      ->needs(picture);
  command
      ->add_option("--gap", options->picture.gap_mm,
                   "set the gap to this for the picture, mm (default: wait for a touch)")
      ->needs(picture);
  command->callback([=] {
    if (options->headless) {
      choice->action = [=](const CommandContext& context) { return RunHeadless(*options, context); };
    } else {
      choice->console = ConsoleRequest{{}, true, options->out / "session.db", {}};
      if (!options->picture.png.empty()) choice->console->picture = options->picture;
    }
  });
}

}  // namespace elbowroom::cli
