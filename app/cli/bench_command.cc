// elbowroom bench [NAME]: quick benchmarks on this machine.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <memory>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/control/benchmarks.h"

namespace elbowroom::cli {
namespace {

CommandResult Run(const std::string& name, const CommandContext& context) {
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
  command->footer(footer);
  auto name = std::make_shared<std::string>();
  command->add_option("NAME", *name, "one benchmark alone (default: all)");
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return Run(*name, context); }; });
}

}  // namespace elbowroom::cli
