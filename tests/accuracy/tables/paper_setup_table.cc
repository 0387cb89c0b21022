// docs/performance.md, "paper_setup".
#include <fmt/format.h>

#include "tests/accuracy/measurements.h"
#include "tests/accuracy/method_comparison.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"

namespace elbowroom::accuracy {
namespace {

using reporting::ThreeDigits;

std::string ViewsASecond(const Timing& timing) { return ThreeDigits(1e3 / timing.median_ms); }

}  // namespace

void MeasurePaperSetup(const std::filesystem::path& docs) {
  fmt::print(stderr, "paper_setup: references\n");
  const ComparedScene scene = MakeComparedScene("paper", recon::ViewSceneRig::kPaper, 320, 240);
  reporting::Table table{{"method", "views a second, 1 thread", "2 threads", "RMS to the masks' hull, mm",
                          "95 %, mm", "wrong pixels, %"},
                         {{"the paper's system, its own figure", "15 to 18", "-", "-", "-", "-"}}};
  fmt::print(stderr, "paper_setup: methods\n");
  for (const MethodResult& result : CompareMethods(scene)) {
    const DepthError& error = result.to_mask_hull;
    table.rows.push_back({result.method.Name(), ViewsASecond(result.one_thread),
                          ViewsASecond(result.two_threads), ThreeDigits(error.surface_rms_mm),
                          ThreeDigits(error.surface_p95_mm),
                          fmt::format("{:.2f}", 100.0 * (error.missing_share + error.extra_share))});
  }
  reporting::WriteSection(
      docs / "performance.md", "paper_setup",
      reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace elbowroom::accuracy
