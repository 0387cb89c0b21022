// docs/performance.md, "methods", and its picture.
#include <fmt/format.h>

#include <utility>

#include "tests/accuracy/measurements.h"
#include "tests/accuracy/method_comparison.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/reporting/pareto_picture.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

std::vector<std::string> RowOf(const std::string& scene, const MethodResult& result) {
  return {
      result.method.Name(),
      scene,
      ThreeDigits(result.one_thread.median_ms),
      ThreeDigits(result.two_threads.median_ms),
      ThreeDigits(result.to_mask_hull.surface_rms_mm),
      ThreeDigits(result.to_mask_hull.surface_p95_mm),
      fmt::format("{:.2f}", 100.0 * (result.to_mask_hull.missing_share + result.to_mask_hull.extra_share)),
      ThreeDigits(result.to_analytic_hull.surface_rms_mm)};
}

}  // namespace

void MeasureMethods(const std::filesystem::path& docs) {
  reporting::Table table{{"method", "scene", "1 thread, ms", "2 threads, ms", "RMS to the masks' hull, mm",
                          "95 %, mm", "wrong pixels, %", "RMS to the analytic hull, mm"},
                         {}};
  reporting::ParetoPicture picture{
      "masks in memory to depth, one thread, ms (median)", "RMS distance to the hull of the masks, mm", {}};
  for (const auto& [name, rig] : {std::pair{"3 cameras, 640 x 480", recon::ViewSceneRig::kThree},
                                  {"paper, 720 x 243", recon::ViewSceneRig::kPaper},
                                  {"8 cameras, 1280 x 720", recon::ViewSceneRig::kEight}}) {
    fmt::print(stderr, "methods: references of {}\n", name);
    const ComparedScene scene = MakeComparedScene(name, rig, 640, 480);
    fmt::print(stderr, "methods: {}\n", name);
    reporting::ParetoPanel panel{fmt::format("Views of 640 x 480 from {}: run time against error", name), {}};
    for (const MethodResult& result : CompareMethods(scene)) {
      table.rows.push_back(RowOf(name, result));
      panel.points.push_back({result.method.family, result.method.setting, result.one_thread.median_ms,
                              result.to_mask_hull.surface_rms_mm});
    }
    if (rig != recon::ViewSceneRig::kPaper) picture.panels.push_back(std::move(panel));
  }
  const reporting::Machine machine = reporting::ThisMachine(docs / "..");
  reporting::WriteSection(docs / "performance.md", "methods",
                          reporting::ToMarkdown(table) + "\n" + reporting::ToLine(machine));
  reporting::DrawPareto(picture, docs / "pictures/view_methods");
}

}  // namespace elbowroom::accuracy
