// docs/performance.md, "hard".
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tests/accuracy/hard/hard_costs.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/quantile.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

constexpr TimingEffort kHardEffort{.repetitions = 7, .slow_repetitions = 3, .slow_ms = 20.0};

std::vector<double> TimesOf(const std::vector<HardCost>& costs) {
  std::vector<double> times_ms;
  for (const HardCost& cost : costs) times_ms.push_back(cost.ms);
  return times_ms;
}

std::string PlaceText(const HardCost& cost) {
  return fmt::format("{}; {}; {}", cost.hull, cost.part, cost.place);
}

std::string ErrorText(const HardKind& kind) {
  if (kind.checked == 0) return "-";
  const std::string wrong = fmt::format("{} of {} wrong", kind.wrong, kind.checked);
  return kind.unit.empty() ? wrong : fmt::format("{}; at most {:.2g} {}", wrong, kind.worst_error, kind.unit);
}

reporting::Table KindTable(const std::vector<HardKind>& kinds) {
  reporting::Table table{{"what is asked", "cases", "half take less than, ms", "99 %, ms", "worst, ms",
                          "worst / half", "the worst: hull; part; place", "error"},
                         {}};
  for (const HardKind& kind : kinds) {
    const std::vector<double> times_ms = TimesOf(kind.costs);
    const double median_ms = Quantile(times_ms, 0.5);
    const HardCost& worst = std::ranges::max(kind.costs, {}, &HardCost::ms);
    table.rows.push_back({kind.name, std::to_string(kind.costs.size()), ThreeDigits(median_ms),
                          ThreeDigits(Quantile(times_ms, 0.99)), ThreeDigits(worst.ms),
                          fmt::format("{:.1f} x", worst.ms / median_ms), PlaceText(worst), ErrorText(kind)});
  }
  return table;
}

// Whether the worst case has more to do, or takes longer for as much.
reporting::Table WorkTable(const std::vector<HardKind>& kinds) {
  reporting::Table table{{"what is asked", "counted", "half have fewer than", "the worst has",
                          "time of each: half take less than, µs", "in the worst, µs"},
                         {}};
  const auto each_us = [](const HardCost& cost) { return 1e3 * cost.ms / std::max(cost.work, 1.0); };
  for (const HardKind& kind : kinds) {
    std::vector<double> work, times_us;
    for (const HardCost& cost : kind.costs) {
      work.push_back(cost.work);
      times_us.push_back(each_us(cost));
    }
    const HardCost& worst = std::ranges::max(kind.costs, {}, &HardCost::ms);
    table.rows.push_back({kind.name, kind.counted, fmt::format("{:.0f}", Quantile(work, 0.5)),
                          fmt::format("{:.0f}", worst.work), ThreeDigits(Quantile(times_us, 0.5)),
                          ThreeDigits(each_us(worst))});
  }
  return table;
}

// Median and worst of what is asked about a part, by the part.
reporting::Table PartTable(const std::vector<HardKind>& kinds) {
  const std::vector<std::string> names = {"contacts, touching", "contacts, amid", "clearance, beside",
                                          "clearance, around", "heat map, touching"};
  std::map<std::string, std::map<std::string, std::vector<double>>> times_ms;  // by part, by name
  for (const HardKind& kind : kinds)
    for (const HardCost& cost : kind.costs) times_ms[cost.part][kind.name].push_back(cost.ms);
  reporting::Table table{{"part: half take less than, and the worst, ms"}, {}};
  table.header.insert(table.header.end(), names.begin(), names.end());
  for (auto& [part, by_name] : times_ms) {
    if (!by_name.contains("contacts, touching")) continue;
    std::vector<std::string> row = {part};
    for (const std::string& name : names) {
      const std::vector<double>& times = by_name[name];
      row.push_back(times.empty() ? "-"
                                  : fmt::format("{}, {}", ThreeDigits(Quantile(times, 0.5)),
                                                ThreeDigits(std::ranges::max(times))));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

void MeasureHardShapes(const std::filesystem::path& docs) {
  const std::vector<HardKind> kinds = MeasureHardCosts({}, kHardEffort);
  reporting::WriteSection(
      docs / "performance.md", "hard",
      fmt::format("{}\n{}\n{}\n{}", reporting::ToMarkdown(KindTable(kinds)),
                  reporting::ToMarkdown(WorkTable(kinds)), reporting::ToMarkdown(PartTable(kinds)),
                  reporting::ToLine(reporting::ThisMachine(docs / ".."))));
}

}  // namespace elbowroom::accuracy
