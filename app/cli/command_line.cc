#include "app/cli/command_line.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/interrupt.h"
#include "app/cli/standard_streams.h"
#include "app/control/versions.h"
#include "core/error.h"
#include "core/plain_text.h"

namespace elbowroom::cli {
namespace {

constexpr int kUsageError = 2;
constexpr int kFailure = 1;

constexpr std::string_view kClearLine = "\r\033[K";

core::Progress TerminalProgress() {
  if (!isatty(STDERR_FILENO)) return {};
  return core::Progress([](std::int64_t done, std::int64_t total, const std::string& what) {
    std::string line(kClearLine);
    line += core::OneLine(what);
    if (total > 0) {
      line += fmt::format(" {} of {}", done, total);
    } else {
      line += done > 0 ? fmt::format(" {}", done) : " …";
    }
    if (total > 0 && done == total) line += kClearLine;
    WriteToStderr(line);
  });
}

void ClearProgress() {
  if (isatty(STDERR_FILENO)) WriteToStderr(kClearLine);
}

// Prints one line, whatever characters names from files and the command line contain.
void PrintToStderr(const std::string& message) {
  constexpr std::string_view kWho = "elbowroom: ";
  ClearProgress();
  const std::size_t room = core::kLongestMessageBytes - kWho.size() - 1;
  WriteToStderr(fmt::format("{}{}\n", kWho, core::OneLine(message, room)));
}

// For lines while a command runs. They go to a terminal only: stderr in a log has just the line of a failure.
void TellTerminal(const std::string& line) {
  if (isatty(STDERR_FILENO)) PrintToStderr(line);
}

int Fail(const std::string& line) {
  PrintToStderr(line);
  return kFailure;
}

int Guarded(const std::function<int()>& work) {
  try {
    return work();
  } catch (const core::Error& error) {
    return Fail(error.what());
  } catch (const std::bad_alloc&) {
    return Fail("out of memory; choose a coarser resolution or a smaller workspace");
  } catch (const std::filesystem::filesystem_error& error) {
    return Fail(fmt::format("{}: {}; check the path and the folder that you are in", error.path1().string(),
                            error.code().message()));
  } catch (const std::exception& error) {
    return Fail(
        fmt::format("internal error: {}; please report it with the command that you ran", error.what()));
  }
}

// In the order that CLI11 wants, the last one first. CLI11 takes "-.5" for an option, but not "-0.5".
std::vector<std::string> ArgumentsOf(int argc, char** argv) {
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  for (std::string& argument : arguments)
    if (argument.size() > 2 && argument.starts_with("-.") && argument[2] >= '0' && argument[2] <= '9')
      argument.insert(1, "0");
  std::ranges::reverse(arguments);
  return arguments;
}

int RunAction(const CommandAction& action, bool json) {
  const InterruptWatch interrupt;
  const CommandResult result = action({TerminalProgress(), interrupt.stop(), TellTerminal});
  ClearProgress();
  // A path may hold bytes that aren't UTF-8, which JSON must be: they are shown as U+FFFD.
  WriteToStdout(
      (json ? result.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) : result.text) +
      '\n');
  if (!result.hint.empty()) PrintToStderr(result.hint);
  return result.failure.empty() ? 0 : Fail(result.failure);
}

// Help and version are results and go to stdout; wrong usage gives one line on stderr.
int EndOfParsing(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream out, told;
  if (app.exit(error, out, told) == 0)
    return Guarded([&] {
      WriteToStdout(out.str());
      return 0;
    });
  PrintToStderr(fmt::format("{}; run it with --help for what there is", error.what()));
  return kUsageError;
}

}  // namespace

int RunCommandLine(int argc, char** argv, const OpenConsole& open_console) {
  CLI::App app{"Will a human fit? Real hands and tools against virtual CAD, before any hardware is built.",
               argc > 0 ? argv[0] : "elbowroom"};
  app.set_version_flag("--version", "elbowroom " + control::ProgramVersion());
  CommonOptions common;
  app.add_flag("--json", common.json, "print one JSON object on stdout");
  app.add_option("--threads", common.threads, "threads to use (default: all cores)")
      ->check(CLI::Range(1, 1024));
  app.fallthrough();  // so that common options may also come after the subcommand
  app.require_subcommand(0, 1);
  Choice choice;
  AddDemoCommand(app, &choice);
  AddTrialCommand(app, &choice);
  AddReplayCommand(app, &choice);
  AddReportCommand(app, &choice);
  AddSweepCommand(app, &choice);
  AddPlanCommand(app, &choice);
  AddSimulateCommand(app, &choice);
  AddStudyCommand(app, &choice);
  AddKeepoutCommand(app, &choice);
  AddTouchesCommand(app, &choice);
  AddSessionsCommand(app, &choice);
  AddBackgroundCommand(app, &choice);
  AddBoardCommand(app, &choice);
  AddSegmentCommand(app, &choice);
  AddViewCommand(app, &choice);
  AddHullCommand(app, &choice);
  AddContactsCommand(app, &choice);
  AddCoverageCommand(app, &choice);
  AddClearanceCommand(app, &choice);
  AddCalibrateCommand(app, &choice);
  AddCamerasCommand(app, &choice);
  AddRigCommand(app, &choice);
  AddGaugeCommand(app, &choice);
  AddHeadCommand(app, &choice);
  AddClashCommand(app, &choice);
  AddImportCommand(app, &choice);
  AddLayoutCommand(app, &choice);
  AddBenchCommand(app, &choice);
  AddOpenCommand(app, &choice);
  AddReferenceCommand(app, &choice);
  try {
    app.parse(ArgumentsOf(argc, argv));
  } catch (const CLI::ParseError& error) {
    return EndOfParsing(app, error);
  }
  std::optional<tbb::global_control> limit;
  if (common.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(common.threads));
  }
  if (choice.action) return Guarded([&] { return RunAction(choice.action, common.json); });
  if (!open_console) return Fail("this build has no window; use a subcommand (see --help)");
  return Guarded([&] { return open_console(choice.console.value_or(ConsoleRequest{})); });
}

}  // namespace elbowroom::cli
