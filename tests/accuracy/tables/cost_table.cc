// docs/performance.md, "cost".
#include <fmt/format.h>

#include <charconv>

#include "core/error.h"
#include "tests/accuracy/callgrind.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

struct CostCase {
  std::string what;
  std::vector<std::string> arguments;  // of view_cost
};

std::vector<CostCase> CostCases() {
  return {{"as it is: view 640 x 480", {}},
          {"eight cameras, 1280 x 720", {"--eight"}},
          {"hull half as wide on screen", {"--zoom", "0.5"}},
          {"hull twice as wide on screen", {"--zoom", "2"}},
          {"view 1280 x 960, hull as large in pixels", {"--view-size", "2"}},
          {"rig's pictures twice as wide and high, hull as large in pixels", {"--picture-size", "2"}},
          {"workspace four times as wide, deep and high", {"--workspace-size", "4"}},
          {"view turned away from the hull", {"--away"}},
          {"one camera sees nothing", {"--blind"}},
          {"unchanged masks, same view", {"--unchanged"}},
          {"unchanged masks, new view", {"--unchanged", "--moved"}}};
}

}  // namespace

void MeasureCost(const std::filesystem::path& docs, const std::filesystem::path& view_cost) {
  reporting::Table table{{"case", "hull on screen, pixels", "million instructions", "of the first"}, {}};
  double first = 0.0;
  for (const CostCase& cost_case : CostCases()) {
    fmt::print(stderr, "cost: {}\n", cost_case.what);
    const CallgrindCount count = CountInstructions(view_cost, cost_case.arguments, "*CountedView*");
    const double instructions = static_cast<double>(count.instructions);
    if (first == 0.0) first = instructions;
    table.rows.push_back({cost_case.what, count.output, fmt::format("{:.1f}", 1e-6 * instructions),
                          fmt::format("{:.2f}", instructions / first)});
  }
  const reporting::Machine machine = reporting::ThisMachine(docs / "..");
  reporting::WriteSection(docs / "performance.md", "cost",
                          reporting::ToMarkdown(table) + "\n" + reporting::ToLine(machine));
}

}  // namespace elbowroom::accuracy
