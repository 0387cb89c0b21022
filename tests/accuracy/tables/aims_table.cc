// docs/performance.md, "aims": the tables "methods" and "micro" held to what was aimed at.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "tests/accuracy/measurements.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/text_file.h"

namespace elbowroom::accuracy {
namespace {

using reporting::Table;
using reporting::ThreeDigits;

constexpr const char* kThree = "3 cameras, 640 x 480";
constexpr const char* kEight = "8 cameras, 1280 x 720";
constexpr const char* kExact = "exact view, CPU";

[[noreturn]] void FailFor(const std::string& what) {
  throw core::Error(
      core::ErrorKind::kFormat,
      fmt::format("performance.md: its tables have no {}; measure 'methods' and 'micro' anew", what));
}

// The tables of one document.
class Measured {
 public:
  explicit Measured(const std::string& document)
      : methods_(reporting::TableOf(reporting::SectionOf(document, "methods", "performance.md"))),
        micro_(reporting::TableOf(reporting::SectionOf(document, "micro", "performance.md"))) {}

  // Of the table of methods, all of which run in turns.
  [[nodiscard]] double InTurnsMs(const std::string& method, const std::string& scene, int threads) const {
    for (const std::vector<std::string>& row : methods_.rows)
      if (row[0] == method && row[1] == scene) return Number(row[threads == 1 ? 2 : 3]);
    FailFor(fmt::format("'{}' of '{}'", method, scene));
  }

  // Of the table of single steps, each repeated by itself.
  [[nodiscard]] double AloneMs(const std::string& benchmark) const {
    for (const std::vector<std::string>& row : micro_.rows) {
      if (row[0] != benchmark) continue;
      const std::size_t space = row[1].find(' ');
      const std::string unit = space == std::string::npos ? "" : row[1].substr(space + 1);
      const double value = Number(row[1].substr(0, space));
      if (unit == "ns") return 1e-6 * value;
      if (unit == "us") return 1e-3 * value;
      if (unit == "ms") return value;
    }
    FailFor(fmt::format("time of '{}'", benchmark));
  }

 private:
  static double Number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      FailFor(fmt::format("number in '{}'", text));
    return value;
  }

  Table methods_;
  Table micro_;
};

const char* MetText(bool is_met) { return is_met ? "yes" : "no"; }

// At most so many ms on one thread and on two; 0: nothing is asked of it.
std::vector<std::string> TimeRow(const std::string& what, double one_aim_ms, double two_aim_ms, double one_ms,
                                 double two_ms) {
  const auto told = [](double value) { return value > 0.0 ? ThreeDigits(value) : std::string("-"); };
  const auto aim = [&](double value_ms) { return value_ms > 0.0 ? "<= " + told(value_ms) + " ms" : "-"; };
  const bool is_met =
      (one_aim_ms == 0.0 || one_ms <= one_aim_ms) && (two_aim_ms == 0.0 || two_ms <= two_aim_ms);
  return {what, aim(one_aim_ms), told(one_ms), aim(two_aim_ms), told(two_ms), MetText(is_met)};
}

// The exact view against another method: at least so many times faster on one thread and on two.
std::vector<std::string> RatioRow(const Measured& measured, const std::string& method, const char* scene,
                                  double at_least) {
  const auto ratio = [&](int threads) {
    return measured.InTurnsMs(method, scene, threads) / measured.InTurnsMs(kExact, scene, threads);
  };
  const std::string aim = fmt::format(">= {} x", at_least);
  return {fmt::format("exact view against {}: {}", method, scene),
          aim,
          fmt::format("{:.1f} x", ratio(1)),
          aim,
          fmt::format("{:.1f} x", ratio(2)),
          MetText(std::min(ratio(1), ratio(2)) >= at_least)};
}

}  // namespace

void WriteAimsTable(const std::filesystem::path& docs) {
  const std::filesystem::path file = docs / "performance.md";
  const Measured measured(test_support::ReadText(file));
  const auto alone = [&](const char* name, int threads) {
    return measured.AloneMs(fmt::format("{}/{}", name, threads));
  };
  Table table{{"aim", "1 thread", "measured", "2 threads", "measured", "met"}, {}};
  for (const auto& [scene, name, one_ms, two_ms] : {std::tuple{kThree, "ExactView/three_cameras", 2.0, 1.2},
                                                    {kEight, "ExactView/eight_cameras", 5.0, 2.8}}) {
    table.rows.push_back(TimeRow(fmt::format("exact view in turns with all methods: {}", scene), one_ms,
                                 two_ms, measured.InTurnsMs(kExact, scene, 1),
                                 measured.InTurnsMs(kExact, scene, 2)));
    table.rows.push_back(TimeRow(fmt::format("exact view repeated alone: {}", scene), one_ms, two_ms,
                                 alone(name, 1), alone(name, 2)));
  }
  for (const char* scene : {kThree, kEight})
    table.rows.push_back(RatioRow(measured, "plane sweep, GL, planes 15 mm apart", scene, 25.0));
  for (const char* sweep :
       {"plain plane sweep, CPU, planes 15 mm apart", "plane sweep, CPU, planes 15 mm apart"})
    for (const char* scene : {kThree, kEight}) table.rows.push_back(RatioRow(measured, sweep, scene, 3.0));
  for (const auto& [what, name] : {std::pair{"the demo's four cameras", "MeshAt2Mm/four_cameras"},
                                   {kThree, "MeshAt2Mm/three_cameras"},
                                   {kEight, "MeshAt2Mm/eight_cameras"}}) {
    table.rows.push_back(TimeRow(fmt::format("hull mesh, edges of 2 mm: {}", what), 0.0, 10.0, alone(name, 1),
                                 alone(name, 2)));
  }
  const double mog2_ms = measured.AloneMs("OpenCvMog2");
  for (const auto& [what, name] :
       {std::pair{"detection", "SegmentDetect"}, {"whole, with levels", "SegmentWhole"}}) {
    const double time_ms = measured.AloneMs(name);
    table.rows.push_back(
        TimeRow(fmt::format("segmentation of 4 pictures: {}", what), 0.6, 0.0, time_ms, 0.0));
    table.rows.push_back({fmt::format("segmentation against MOG2: {}", what), ">= 15 x",
                          fmt::format("{:.1f} x", mog2_ms / time_ms), "-", "-",
                          MetText(mog2_ms >= 15.0 * time_ms)});
  }
  reporting::WriteSection(file, "aims", reporting::ToMarkdown(table));
}

}  // namespace elbowroom::accuracy
