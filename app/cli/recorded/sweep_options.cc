#include "app/cli/recorded/sweep_options.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <utility>

#include "app/cli/options/unit_option.h"

namespace elbowroom::cli {

std::optional<control::SpacingRange> ParseSpacingRange(const std::string& text) {
  const std::size_t equals = text.rfind('='),
                    first = text.find(':', equals == std::string::npos ? 0 : equals),
                    second = first == std::string::npos ? first : text.find(':', first + 1);
  if (equals == std::string::npos || equals == 0 || second == std::string::npos) return std::nullopt;
  const auto from_mm = ParseNumber(text.substr(equals + 1, first - equals - 1)),
             to_mm = ParseNumber(text.substr(first + 1, second - first - 1)),
             step_mm = ParseNumber(text.substr(second + 1));
  if (!from_mm || !to_mm || !step_mm || !(*step_mm > 0.0) || *to_mm < *from_mm) return std::nullopt;
  return control::SpacingRange{text.substr(0, equals), *from_mm, *to_mm, *step_mm};
}

void AddEngineOption(CLI::App& command, control::SweepEngine* engine) {
  command
      .add_option_function<std::string>(
          "--engine", [engine](const std::string& text) { *engine = *control::ParseSweepEngine(text); },
          "who judges: this process, processes of GNU parallel, or an array of Slurm")
      ->check(CLI::IsMember({"local", "parallel", "slurm"}))
      ->default_str("local");
}

std::string RunEngine(control::SweepEngine engine, control::SweepRequest* request,
                      const CommandContext& context) {
  if (engine == control::SweepEngine::kLocal) return "";
  const auto threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  control::EngineOutcome outcome =
      control::RunSweepEngine(engine, *request, threads, context.progress, context.stop);
  request->cells_before = std::move(outcome.cells_before);
  if (outcome.begun_again == 0) return "";
  return fmt::format("{} times a process was killed from outside and begun again; which ones is in '{}'",
                     outcome.begun_again, (request->folder / "engine" / "killed").string());
}

}  // namespace elbowroom::cli
