// docs/performance.md, "judging", "judging_cost" and "judging_shapes", and the pictures of the first.
#include <fmt/format.h>

#include "tests/accuracy/judging_comparison.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/shape_costs.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/reporting/pareto_picture.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

constexpr int kPoses = 24;
constexpr double kMeshEdgesMm[] = {8.0, 4.0, 2.0};
constexpr std::uint64_t kJudgingSeed = 7801;
constexpr TimingEffort kJudgingEffort{.repetitions = 11, .slow_repetitions = 3, .slow_ms = 20.0};
constexpr TimingEffort kCostEffort{.repetitions = 201};
constexpr int kShapeTriangles[] = {720, 28'320, 1'000'000};

reporting::Table MethodTable(const std::vector<JudgingMethod>& contacts,
                             const std::vector<JudgingMethod>& clearances) {
  reporting::Table table{{"method", "setting", "time, ms", "error, RMS", "at most", "promised", "missed"},
                         {}};
  const auto add = [&](const std::vector<JudgingMethod>& methods, const std::string& unit, bool may_miss) {
    for (const JudgingMethod& method : methods) {
      const auto in_unit = [&](double error) { return ThreeDigits(error) + unit; };
      table.rows.push_back({method.family, method.setting, ThreeDigits(method.time_ms),
                            in_unit(method.rms_error), in_unit(method.worst_error),
                            method.promised > 0.0 ? in_unit(method.promised) : "-",
                            may_miss ? fmt::format("{} of {}", method.missed, kPoses) : "-"});
    }
  };
  add(contacts, " %", true);
  add(clearances, " mm", false);
  return table;
}

reporting::Table CostTable(const std::vector<JudgingCost>& costs) {
  reporting::Table table{{"case", "triangles", "cameras", "hull, cm³", "contact area, mm²", "contacts, ms",
                          "queries", "triangles skipped, %", "clearance, ms", "queries"},
                         {}};
  for (const JudgingCost& cost : costs) {
    table.rows.push_back({cost.what, std::to_string(cost.triangles), std::to_string(cost.cameras),
                          fmt::format("{:.0f}", cost.hull_cm3), fmt::format("{:.0f}", cost.contact_area_mm2),
                          ThreeDigits(cost.contacts.median_ms), std::to_string(cost.contact_queries),
                          fmt::format("{:.1f}", 100.0 * cost.skipped_triangles),
                          ThreeDigits(cost.clearance.median_ms), std::to_string(cost.clearance_queries)});
  }
  return table;
}

reporting::Table ShapeTable(const std::vector<ShapeCost>& costs) {
  reporting::Table table{{"part", "triangles", "clearance, ms", "error, mm", "promised, mm",
                          "queries of the hull", "distances to the part"},
                         {}};
  for (const ShapeCost& cost : costs) {
    table.rows.push_back({cost.shape, std::to_string(cost.triangles), ThreeDigits(cost.clearance.median_ms),
                          ThreeDigits(cost.error_mm), ThreeDigits(cost.promised_mm),
                          std::to_string(cost.queries), std::to_string(cost.distances)});
  }
  return table;
}

void Draw(const std::string& title, const std::string& error_label, const std::vector<JudgingMethod>& methods,
          const std::filesystem::path& stem) {
  reporting::ParetoPanel panel{title, {}};
  // The peers first: the second family's labels stand beside its line, which is steep.
  const std::string& own = methods.front().family;
  for (const bool is_own : {false, true})
    for (const JudgingMethod& method : methods)
      if ((method.family == own) == is_own)
        panel.points.push_back({method.family, method.setting, method.time_ms, method.rms_error});
  reporting::DrawPareto({"hull in memory to answer, one thread, ms", error_label, {std::move(panel)}}, stem);
}

}  // namespace

void MeasureJudging(const std::filesystem::path& docs) {
  fmt::print(stderr, "judging: contacts\n");
  const std::vector<JudgingMethod> contacts = CompareContactAreas(kPoses, kJudgingSeed, kJudgingEffort);
  fmt::print(stderr, "judging: clearance\n");
  const std::vector<JudgingMethod> clearances =
      CompareClearances(kPoses, kJudgingSeed, kMeshEdgesMm, kJudgingEffort);
  fmt::print(stderr, "judging: costs\n");
  const std::vector<JudgingCost> costs = MeasureJudgingCosts(kCostEffort);
  fmt::print(stderr, "judging: shapes\n");
  const std::vector<ShapeCost> shapes = MeasureShapeCosts(kShapeTriangles, kCostEffort);
  const std::filesystem::path file = docs / "performance.md";
  const std::string machine = fmt::format("\n{}", reporting::ToLine(reporting::ThisMachine(docs / "..")));
  reporting::WriteSection(file, "judging",
                          reporting::ToMarkdown(MethodTable(contacts, clearances)) + machine);
  reporting::WriteSection(file, "judging_cost", reporting::ToMarkdown(CostTable(costs)) + machine);
  reporting::WriteSection(file, "judging_shapes", reporting::ToMarkdown(ShapeTable(shapes)) + machine);
  Draw("Contacts of a panel of 720 triangles: run time against error", "RMS error of the contact area, %",
       contacts, docs / "pictures/contact_methods");
  Draw("Clearance of the panel, 5 to 60 mm: run time against error", "RMS error, mm", clearances,
       docs / "pictures/clearance_methods");
}

}  // namespace elbowroom::accuracy
