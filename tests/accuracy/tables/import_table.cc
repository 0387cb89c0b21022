// docs/cad_import.md, "import".
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "tests/accuracy/bumpy_ball.h"
#include "tests/accuracy/interleaved_timing.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/peak_memory.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;

constexpr int kRuns = 15;

// A whole command, as a user runs it.
struct ImportCase {
  std::string what;
  std::vector<std::string> arguments;
  bool is_cached = true;
};

// What all ended children of this process have used.
double ProcessorMs() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto ms = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

// Returns the processor's time, which other programs disturb less than the clock's.
double Run(const fs::path& program, const ImportCase& import_case, const fs::path& cache) {
  if (!import_case.is_cached) fs::remove_all(cache);
  const double before_ms = ProcessorMs();
  const auto run = test_support::RunProgram(program, import_case.arguments);
  if (run.exit_status != 0) throw core::Error(core::ErrorKind::kFile, run.err);
  return ProcessorMs() - before_ms;
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string MegabytesText(std::int64_t bytes) {
  return bytes == 0 ? "-" : fmt::format("{:.0f}", 1e-6 * static_cast<double>(bytes));
}

}  // namespace

void MeasureImport(const fs::path& docs, const fs::path& program) {
  constexpr int kRings = 708;
  const test_support::TemporaryFolder folder;
  const fs::path file = folder / "ball.stl", cache = folder / "cache";
  const core::TriangleMesh ball = BumpyBall(kRings);
  cad_import::WriteMeshFile(ball, file);
  ::setenv("ELBOWROOM_CACHE", cache.c_str(), 1);
  const std::vector<std::string> import = {"import", file.string(), "--unit", "mm"};
  const std::array<ImportCase, 3> cases = {{{"the start alone: `--version`", {"--version"}},
                                            {"`import`, nothing in the cache", import, false},
                                            {"`import`, from the cache", import}}};
  std::vector<std::function<void()>> jobs;
  std::array<std::vector<double>, cases.size()> processor_ms;
  for (std::size_t i = 0; i < cases.size(); ++i)
    jobs.emplace_back([&, i] { processor_ms[i].push_back(Run(program, cases[i], cache)); });
  fmt::print(stderr, "import: {} triangles, {} runs of {} commands\n", ball.triangles.size(), kRuns,
             jobs.size());
  const std::vector<Timing> timings = TimeInTurns(jobs, 1, {.repetitions = kRuns, .slow_repetitions = kRuns});
  reporting::Table table{{"command", "time, ms", "of the processor, ms", "peak memory, MB",
                          "of its child, MB", "both, of the file's size"},
                         {}};
  const auto file_bytes = static_cast<double>(fs::file_size(file));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].is_cached) fs::remove_all(cache);
    const PeakMemory peak = PeakMemoryOf(program, cases[i].arguments);
    const double of_file = static_cast<double>(peak.program_bytes + peak.child_bytes) / file_bytes;
    table.rows.push_back({cases[i].what, fmt::format("{:.0f}", timings[i].median_ms),
                          fmt::format("{:.0f}", MedianOf(processor_ms[i])), MegabytesText(peak.program_bytes),
                          MegabytesText(peak.child_bytes), fmt::format("{:.1f}", of_file)});
  }
  reporting::WriteSection(
      docs / "cad_import.md", "import",
      fmt::format("A binary STL of {} triangles, {:.1f} MB; medians of {} runs.\n\n{}\n{}",
                  ball.triangles.size(), 1e-6 * file_bytes, kRuns, reporting::ToMarkdown(table),
                  reporting::ToLine(reporting::ThisMachine(docs / ".."))));
}

}  // namespace elbowroom::accuracy
