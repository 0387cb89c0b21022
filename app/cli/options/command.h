// What every subcommand of the program shares.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "core/progress.h"

namespace elbowroom::cli {

// Options that every subcommand takes.
struct CommonOptions {
  bool json = false;  // one JSON object on stdout instead of text
  int threads = 0;    // 0: all cores
};

// What a running command can use.
struct CommandContext {
  core::Progress progress;  // a line on a terminal, else nothing
  std::stop_token stop;     // asked for by Ctrl-C
  // Prints a line at once on a terminal; elsewhere it does nothing. Thread: any.
  std::function<void(const std::string&)> tell;
};

// A command's result: the JSON that --json prints, and the text that is printed otherwise. `hint` goes to
// stderr in either case: a line on a result that the user may not have expected; empty: none. `failure` is
// the line of a command that found something wrong, and says what in its result; the exit status is 1 then.
struct CommandResult {
  nlohmann::json json;
  std::string text;
  std::string hint = {};
  std::string failure = {};
};

// What a subcommand does once its arguments have been read.
using CommandAction = std::function<CommandResult(const CommandContext&)>;

// A picture of the window at work, after which it closes.
struct WindowPictureRequest {
  std::filesystem::path png;
  double after_s = 0.0;          // of the trial's time
  std::optional<double> gap_mm;  // set the layout's first spacing to this; nothing: wait for a touch
};

// What the window is opened with.
struct ConsoleRequest {
  std::filesystem::path trial_file;  // empty: none
  bool demo = false;                 // start the demo at once
  std::filesystem::path session;     // empty: the window asks
  std::optional<WindowPictureRequest> picture;
};

// What the command line chose.
struct Choice {
  CommandAction action;  // empty: the window opens, with `console` if it is set
  std::optional<ConsoleRequest> console;
};

// Each adds one subcommand and its options to `app`; when it is given, `*choice` is set.
void AddBackgroundCommand(CLI::App& app, Choice* choice);
void AddBenchCommand(CLI::App& app, Choice* choice);
void AddBoardCommand(CLI::App& app, Choice* choice);
void AddCalibrateCommand(CLI::App& app, Choice* choice);
void AddCamerasCommand(CLI::App& app, Choice* choice);
void AddClashCommand(CLI::App& app, Choice* choice);
void AddClearanceCommand(CLI::App& app, Choice* choice);
void AddContactsCommand(CLI::App& app, Choice* choice);
void AddCoverageCommand(CLI::App& app, Choice* choice);
void AddDemoCommand(CLI::App& app, Choice* choice);
void AddGaugeCommand(CLI::App& app, Choice* choice);
void AddHeadCommand(CLI::App& app, Choice* choice);
void AddHullCommand(CLI::App& app, Choice* choice);
void AddImportCommand(CLI::App& app, Choice* choice);
void AddKeepoutCommand(CLI::App& app, Choice* choice);
void AddLayoutCommand(CLI::App& app, Choice* choice);
void AddOpenCommand(CLI::App& app, Choice* choice);
void AddReferenceCommand(CLI::App& app, Choice* choice);
void AddReplayCommand(CLI::App& app, Choice* choice);
void AddReportCommand(CLI::App& app, Choice* choice);
void AddSessionsCommand(CLI::App& app, Choice* choice);
void AddTouchesCommand(CLI::App& app, Choice* choice);
void AddRigCommand(CLI::App& app, Choice* choice);
void AddSegmentCommand(CLI::App& app, Choice* choice);
void AddSimulateCommand(CLI::App& app, Choice* choice);
void AddPlanCommand(CLI::App& app, Choice* choice);
void AddStudyCommand(CLI::App& app, Choice* choice);
void AddSweepCommand(CLI::App& app, Choice* choice);
void AddTrialCommand(CLI::App& app, Choice* choice);
void AddViewCommand(CLI::App& app, Choice* choice);

}  // namespace elbowroom::cli
