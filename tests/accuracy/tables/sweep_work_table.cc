// docs/plane_sweep.md, "work" and "work_methods".
#include <fmt/format.h>

#include "tests/accuracy/measurements.h"
#include "tests/accuracy/sweep_work.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

// A figure of the paper's "Performance", in a second, and its formula's value for one sweep.
struct PaperFigure {
  std::string what, formula;
  double in_a_second = 0.0, of_a_sweep = 0.0;
};

// n = 3 cameras, l = 50 planes, u x v pixels, a grid of i x j = 5 x 5.
constexpr double kCameras = 3.0, kPlanes = 50.0, kCells = kPaperCells * kPaperCells;
constexpr double kFieldPx = 720.0 * 243.0, kFramePx = 720.0 * 486.0, kWindowPx = 320.0 * 240.0;
// The paper's formulas.
constexpr double kTriangles = (2.0 * kCameras * kCells + 2.0) * kPlanes;
constexpr double kFilledPx = (kCameras + 1.0) * kPlanes * kWindowPx;

std::vector<std::string> RowOf(const PaperFigure& figure, std::int64_t counted) {
  return {figure.what,
          fmt::format("{:.3g} million", 1e-6 * figure.in_a_second),
          fmt::format("{} = {:.0f}", figure.formula, figure.of_a_sweep),
          fmt::format("{:.1f}", figure.in_a_second / figure.of_a_sweep),
          std::to_string(counted),
          fmt::format("{:.3f}", static_cast<double>(counted) / figure.of_a_sweep)};
}

reporting::Table WorkTable(const SweepWorkResult& result) {
  const SweepWork& paper = result.methods.front();
  const std::int64_t compared = result.segmented.pixels - result.segmented.skipped_pixels;
  return {
      {"work", "the paper, a second", "its formula, a frame", "frames a second of that", "here, a frame",
       "here against the formula"},
      {RowOf({"subtracts and compares, one field a camera", "n u v", 15.7e6, kCameras * kFieldPx}, compared),
       RowOf({"subtracts and compares, whole pictures", "n u v", 15.7e6, kCameras * kFramePx}, compared),
       RowOf({"triangles", "(2 n i j + 2) l", 0.23e6, kTriangles}, paper.triangles),
       RowOf({"pixels filled", "(n + 1) l u v", 0.46e9, kFilledPx}, paper.filled_pixels)}};
}

std::string CountOf(std::int64_t count) { return count > 0 ? std::to_string(count) : "-"; }

reporting::Table MethodTable(const SweepWorkResult& result) {
  reporting::Table table{{"method", "planes", "triangles", "pixels filled, points asked or rays cast",
                          "1 thread, ms", "2 threads, ms", "frames a second", "RMS to the masks' hull, mm",
                          "to the analytic hull, mm", "missing and extra pixels, %"},
                         {}};
  table.rows.push_back({"the paper, on its machine", "about 50", fmt::format("{:.0f}", kTriangles),
                        fmt::format("{:.0f}", kFilledPx), "-", "-", "15-18", "-", "15 (estimated)", "-"});
  for (const SweepWork& method : result.methods) {
    table.rows.push_back(
        {method.method, CountOf(method.planes), CountOf(method.triangles), CountOf(method.filled_pixels),
         ThreeDigits(method.one_thread.median_ms), ThreeDigits(method.two_threads.median_ms),
         ThreeDigits(1000.0 / method.two_threads.median_ms), ThreeDigits(method.to_mask_hull.surface_rms_mm),
         ThreeDigits(method.to_analytic_hull.surface_rms_mm),
         fmt::format("{:.1f}",
                     100.0 * (method.to_analytic_hull.missing_share + method.to_analytic_hull.extra_share))});
  }
  table.rows.push_back({"segmentation alone", "-", "-", "-", ThreeDigits(result.one_thread.median_ms),
                        ThreeDigits(result.two_threads.median_ms),
                        ThreeDigits(1000.0 / result.two_threads.median_ms), "-", "-", "-"});
  return table;
}

}  // namespace

void MeasureSweepWork(const std::filesystem::path& docs) {
  fmt::print(stderr, "work\n");
  const SweepWorkResult result = TimeSweepWork();
  const std::filesystem::path file = docs / "plane_sweep.md";
  const std::string machine = fmt::format("\n{}", reporting::ToLine(reporting::ThisMachine(docs / "..")));
  reporting::WriteSection(file, "work", reporting::ToMarkdown(WorkTable(result)) + machine);
  reporting::WriteSection(file, "work_methods", reporting::ToMarkdown(MethodTable(result)) + machine);
}

}  // namespace elbowroom::accuracy
