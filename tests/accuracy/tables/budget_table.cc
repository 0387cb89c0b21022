// docs/accuracy.md, "budget".
#include <fmt/format.h>

#include "core/error.h"
#include "tests/accuracy/error_budget.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

constexpr BudgetEffort kBudgetEffort{.stride = 3, .draws = 4};

std::string ToString(Convention convention) {
  if (convention == Convention::kNone) return "-";
  return convention == Convention::kSquares ? "pixel squares" : "marching squares";
}

std::string Percent(double share) { return fmt::format("{:.1f}", 100.0 * share); }

std::vector<std::string> RowOf(const BudgetTerm& term, const DepthError& error) {
  using reporting::ThreeDigits;
  return {term.name,
          ThreeDigits(error.surface_rms_mm),
          ThreeDigits(error.surface_mean_mm),
          ThreeDigits(error.surface_p95_mm),
          ThreeDigits(error.mean_mm),
          ThreeDigits(error.mean_abs_mm),
          ThreeDigits(error.rms_mm),
          Percent(error.missing_share),
          Percent(error.extra_share),
          ToString(term.convention),
          term.paper.empty() ? "-" : term.paper};
}

}  // namespace

void MeasureBudget(const std::filesystem::path& docs) {
  fmt::print(stderr, "budget: the references\n");
  const BudgetScene scene = MakeBudgetScene(640, 480);
  reporting::Table table{{"term", "to surface: RMS", "mean", "95 %", "along ray: mean", "mean abs", "RMS",
                          "missing %", "extra %", "convention", "the paper"},
                         {}};
  std::string beyond;
  for (const BudgetTerm& term : BudgetTerms()) {
    fmt::print(stderr, "budget: {}\n", term.name);
    const DepthError error = MeasureTerm(term, scene, kBudgetEffort);
    table.rows.push_back(RowOf(term, error));
    if (!(error.surface_rms_mm < term.ceiling_mm))
      beyond +=
          fmt::format(" {}: {:.3g} mm, ceiling {:.3g} mm;", term.name, error.surface_rms_mm, term.ceiling_mm);
  }
  const reporting::Machine machine = reporting::ThisMachine(docs / "..");
  reporting::WriteSection(docs / "accuracy.md", "budget",
                          reporting::ToMarkdown(table) + "\n" + reporting::ToLine(machine));
  if (!beyond.empty())
    throw core::Error(core::ErrorKind::kRange,
                      "error budget beyond its ceilings (tests/accuracy/error_budget.cc):" + beyond);
}

}  // namespace elbowroom::accuracy
