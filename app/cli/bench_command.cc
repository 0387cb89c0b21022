// elbowroom bench [NAME]: quick benchmarks on this machine.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/standard_streams.h"
#include "app/control/benchmarks.h"
#include "app/control/self_test.h"
#include "core/error.h"

namespace elbowroom::cli {
namespace {

constexpr const char* kSelfTest = "selftest";

// Throws: core::Error{kGraphics} unless the driver passes.
CommandResult RunTheSelfTest() {
  const control::SelfTestReport report = control::RunSelfTest();
  CommandResult result;
  result.json = {{"driver", report.driver}, {"passed", report.Passed()}, {"tests", nlohmann::json::array()}};
  const std::string title = "OpenGL against the processor";
  std::size_t width = title.size();
  for (const control::SelfTestLine& line : report.lines) width = std::max(width, line.what.size());
  result.text = fmt::format("{}\n{:<{}}{:>12}{:>12}{:>14}", report.driver, title, width, "hit pixels",
                            "differing", "unexplained");
  for (const control::SelfTestLine& line : report.lines) {
    result.json["tests"].push_back({{"name", line.what},
                                    {"hit_pixels", line.hit_pixels},
                                    {"differing_pixels", line.differing_pixels},
                                    {"unexplained_pixels", line.unexplained_pixels}});
    result.text += fmt::format("\n{:<{}}{:>12}{:>12}{:>14}", line.what, width, line.hit_pixels,
                               line.differing_pixels, line.unexplained_pixels);
  }
  if (!report.Passed()) {
    WriteToStderr(result.text + '\n');
    throw core::Error(core::ErrorKind::kGraphics,
                      fmt::format("{}: OpenGL's pictures differ from the processor's by more than rounding; "
                                  "update the graphics driver, or use methods exact and sweep",
                                  report.driver));
  }
  return result;
}

CommandResult Run(const std::string& name, const CommandContext& context) {
  if (name == kSelfTest) return RunTheSelfTest();
  std::vector<std::string> names;
  for (const control::BenchmarkKind& kind : control::Benchmarks()) names.emplace_back(kind.name);
  if (!name.empty()) names = {name};
  const std::size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  CommandResult result;
  result.json = {{"threads", threads}, {"benchmarks", nlohmann::json::array()}};
  result.text = fmt::format("{:<14}{:<40}{:>12}{:>12}   ({} threads)", "benchmark", "on", "median, ms",
                            "fastest, ms", threads);
  for (const std::string& each : names) {
    for (const control::BenchmarkTiming& timing :
         control::RunBenchmark(each, context.progress, context.stop)) {
      result.json["benchmarks"].push_back({{"name", each},
                                           {"on", timing.what},
                                           {"time_ms", timing.median_ms},
                                           {"fastest_ms", timing.fastest_ms},
                                           {"repetitions", timing.repetitions}});
      result.text += fmt::format("\n{:<14}{:<40}{:>12.2f}{:>12.2f}", each, timing.what, timing.median_ms,
                                 timing.fastest_ms);
    }
  }
  return result;
}

}  // namespace

void AddBenchCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("bench", "time the program's main steps on this machine");
  std::string footer = "NAME is one of:";
  for (const control::BenchmarkKind& kind : control::Benchmarks())
    footer += fmt::format("\n  {:<14}{}", kind.name, kind.what);
  footer += fmt::format("\n  {:<14}{}", kSelfTest, "does OpenGL compute here what the processor does?");
  command->footer(footer);
  auto name = std::make_shared<std::string>();
  command->add_option("NAME", *name, "one alone (default: all but selftest)");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*name, context); }; });
}

}  // namespace elbowroom::cli
