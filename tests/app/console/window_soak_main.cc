// Measures the window over a long trial of the demo, and writes the table "window" of docs/performance.md.
//   window_soak SIMULATED_SECONDS_AT_30_HZ SIMULATED_SECONDS_AT_10_TIMES [--docs DIR]
#include <fmt/format.h>

#include <QApplication>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "app/console/desktop/theme.h"
#include "cad_import/import_worker.h"
#include "core/spread.h"
#include "tests/app/console/own_home.h"
#include "tests/app/console/window_soak.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace elbowroom;
using reporting::ThreeDigits;

constexpr double kBytesPerMB = 1e6;
constexpr std::array kUpToMs = {5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 75.0, 100.0};

struct Row {
  std::string name;
  console::WindowSoakResult result;
};

// The median of the last fifth less that of the first: buffers that come and go with each picture are a few
// MB.
std::string GrowthOf(const std::vector<double>& resident_bytes) {
  const auto fifth = static_cast<std::ptrdiff_t>(resident_bytes.size() / 5);
  if (fifth == 0) return "\u2013";
  const auto median = [](std::vector<double> bytes) {
    std::ranges::sort(bytes);
    return core::PercentileOf(bytes, 0.5);
  };
  const double first = median({resident_bytes.begin(), resident_bytes.begin() + fifth});
  const double last = median({resident_bytes.end() - fifth, resident_bytes.end()});
  return fmt::format("{:+.2f}", (last - first) / kBytesPerMB);
}

std::vector<std::string> SummaryOf(const Row& row) {
  const auto& result = row.result;
  const auto at = [](std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values.empty() ? std::string("–") : ThreeDigits(core::PercentileOf(values, share));
  };
  const auto spread = [&](const std::vector<double>& values) {
    return fmt::format("{} / {} / {} / {}", at(values, 0.5), at(values, 0.95), at(values, 0.99),
                       at(values, 1.0));
  };
  return {row.name,
          ThreeDigits(result.first_picture_ms),
          ThreeDigits(static_cast<double>(result.frames) / result.seconds),
          ThreeDigits(static_cast<double>(result.drawing_ms.size()) / result.seconds),
          spread(result.between_pictures_ms),
          spread(result.drawing_ms),
          spread(result.ui_waits_ms),
          GrowthOf(result.resident_bytes)};
}

// How many of the values lie up to each edge, and beyond the last one, in per cent.
std::vector<std::string> HistogramOf(const std::string& name, const std::vector<double>& values) {
  std::vector<std::string> cells = {name};
  double from = 0.0;
  const auto share = [&](double above, double up_to) {
    const auto count = std::ranges::count_if(values, [&](double v) { return v > above && v <= up_to; });
    return ThreeDigits(100.0 * static_cast<double>(count) / static_cast<double>(values.size()));
  };
  for (const double edge : kUpToMs) {
    cells.push_back(share(from == 0.0 ? -1.0 : from, edge));
    from = edge;
  }
  cells.push_back(share(from, 1e9));
  return cells;
}

std::string TablesOf(const std::vector<Row>& rows) {
  reporting::Table summary{
      {"trial", "first picture after, ms", "frames/s", "pictures/s", "between pictures, ms",
       "drawing one, ms", "an event of the UI thread waits, ms", "memory, MB"},
      {}};
  reporting::Table histogram{{"share in per cent of what took, in ms"}, {}};
  double from = 0.0;
  for (const double edge : kUpToMs)
    histogram.header.push_back(fmt::format("{:g} to {:g}", std::exchange(from, edge), edge));
  histogram.header.push_back(fmt::format("over {:g}", from));
  for (const Row& row : rows) {
    summary.rows.push_back(SummaryOf(row));
    histogram.rows.push_back(HistogramOf("between pictures, " + row.name, row.result.between_pictures_ms));
    histogram.rows.push_back(HistogramOf("UI thread, " + row.name, row.result.ui_waits_ms));
  }
  return reporting::ToMarkdown(summary) + "\n" + reporting::ToMarkdown(histogram);
}

Row Measure(const std::string& name, const console::WindowSoakPlan& plan) {
  Row row{name, console::SoakWindow(plan)};
  if (!row.result.error.empty()) throw std::runtime_error(row.result.error);
  row.name += fmt::format(", {} x {}", row.result.widest_px, row.result.highest_px);
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  cad_import::ServeImport(argc, argv);
  const console::OwnHome home;
  const QApplication application(argc, argv);
  console::SetTheme(console::Theme::kLight);
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() != 2 && (words.size() != 4 || words[2] != "--docs")) {
    std::cerr << "usage: window_soak SIMULATED_SECONDS_AT_30_HZ SIMULATED_SECONDS_AT_10_TIMES [--docs DIR]\n";
    return 2;
  }
  try {
    const test_support::TemporaryFolder folder;
    const std::vector<Row> rows = {
        Measure("30 Hz", {std::stod(words[0]), 1.0, false, folder / "still.db"}),
        Measure("30 Hz, the eye turns twice a second",
                {std::stod(words[0]), 1.0, true, folder / "turned.db"}),
        Measure("10 times as fast", {std::stod(words[1]), 10.0, false, folder / "fast.db"})};
    const std::string tables = TablesOf(rows);
    std::cout << tables;
    if (words.size() == 4) {
      const std::filesystem::path docs = words[3];
      reporting::WriteSection(docs / "performance.md", "window",
                              ToLine(reporting::ThisMachine(docs.parent_path())) + "\n\n" + tables);
    }
    return EXIT_SUCCESS;
  } catch (const std::exception& failure) {
    std::cerr << failure.what() << "\n";
    return EXIT_FAILURE;
  }
}
