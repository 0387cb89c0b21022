// docs/scale.md, "growth", "engines", "store" and "site": what many sessions cost.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "app/control/demo_parts.h"
#include "cad_import/mesh_file.h"
#include "core/error.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/scale/hull_bounds.h"
#include "tests/accuracy/scale/measured_sweep.h"
#include "tests/app/sweep/one_node_slurm.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;

// What is assumed of a site; everything else is measured.
constexpr double kHours = 10'000.0, kFramesASecond = 30.0;
constexpr double kEuroACoreHour = 0.05, kEuroATerabyteMonth = 20.0;
constexpr double kCores = 100.0;
constexpr double kFramesOfACell = 256.0;

constexpr double kMega = 1e-6, kTera = 1e-12;

// A payload so many times as wide, as a file to be given as a revision.
std::vector<std::string> Revision(const fs::path& folder, const std::string& name, double times_as_wide) {
  core::TriangleMesh mesh = control::PayloadA();
  for (Eigen::Vector3d& x : mesh.vertices_mm) x.head<2>() *= times_as_wide;
  const fs::path file = folder / (name + ".stl");
  cad_import::WriteMeshFile(mesh, file);
  return {"--revision", fmt::format("{}:payload_a={}:mm", name, file.string())};
}

std::int64_t Sum(std::span<const std::int64_t> values) {
  return std::accumulate(values.begin(), values.end(), std::int64_t{0});
}

double BytesIn(const fs::path& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes;
}

std::string YesNo(bool is_so) { return is_so ? "yes" : "NO"; }

class ScaleMeasurement {
 public:
  ScaleMeasurement(const fs::path& docs, const fs::path& program, std::vector<int> sizes, double session_s)
      : docs_(docs), program_(program), sizes_(std::move(sizes)) {
    std::ranges::sort(sizes_);
    fmt::print(stderr, "scale: simulating {} sessions\n", sizes_.back());
    cohort_ = SimulateCohort(program_, folder_ / "cohort", sizes_.back(), session_s);
    for (const auto& [name, width] : {std::pair{"B", 1.3}, std::pair{"C", 0.7}}) {
      const auto revision = Revision(folder_.path(), name, width);
      revisions_.insert(revisions_.end(), revision.begin(), revision.end());
    }
  }

  void MeasureGrowth() {
    reporting::Table table{{"sessions", "frames", "one core, s", "two cores, s", "of ideal",
                            "one core, ms a frame", "memory, MB: one, two", "cells", "same results"},
                           {}};
    std::vector<MeasuredSweep> of_one, of_two;
    for (const int size : sizes_) {
      of_one.push_back(Sweep(fmt::format("one{}", size), size, {"--threads", "1"}));
      of_two.push_back(Sweep(fmt::format("two{}", size), size, {"--threads", "2"}));
    }
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const MeasuredSweep &one = of_one[i], &two = of_two[i];
      const std::int64_t frames = FramesOf(sizes_[i]);
      const bool is_same = HaveSameResults(one.out, two.out) && HasCellsOf(of_one.back().out, one.out);
      table.rows.push_back({std::to_string(sizes_[i]), std::to_string(frames),
                            fmt::format("{:.1f}", one.wall_s), fmt::format("{:.1f}", two.wall_s),
                            fmt::format("{:.0f} %", 100.0 * one.wall_s / (2.0 * two.wall_s)),
                            fmt::format("{:.2f}", 1e3 * one.wall_s / static_cast<double>(frames)),
                            fmt::format("{:.0f}, {:.0f}", kMega * static_cast<double>(one.peak_bytes),
                                        kMega * static_cast<double>(two.peak_bytes)),
                            std::to_string(one.cells), YesNo(is_same)});
    }
    ms_a_frame_ = 1e3 * of_one.back().wall_s / static_cast<double>(FramesOf(sizes_.back()));
    cells_ = of_one.back();
    Write("growth", table);
  }

  // Of the fewest sessions.
  void MeasureEngines() {
    const int size = sizes_.front();
    reporting::Table table{{"engine", "time, s", "more than two cores of one program, s", "a session, ms",
                            "memory of the command, MB", "same results"},
                           {}};
    const MeasuredSweep local = Sweep("local", size, {"--threads", "2"});
    const auto add = [&](const std::string& what, const MeasuredSweep& run, bool is_same) {
      const double more_s = run.wall_s - local.wall_s;
      table.rows.push_back({what, fmt::format("{:.1f}", run.wall_s), fmt::format("{:+.1f}", more_s),
                            fmt::format("{:+.0f}", 1e3 * more_s / size),
                            fmt::format("{:.0f}", kMega * static_cast<double>(run.peak_bytes)),
                            YesNo(is_same)});
    };
    add("`local`, two threads", local, HaveSameResults(local.out, folder_ / fmt::format("one{}", size)));
    const MeasuredSweep parallel = Sweep("parallel", size, {"--engine", "parallel", "--threads", "2"});
    add("`parallel`, two processes", parallel, HaveSameResults(parallel.out, local.out));
    std::string why_not;
    if (const auto slurm = tests::OneNodeSlurm::Start(folder_ / "cluster", 2, &why_not)) {
      const MeasuredSweep run =
          Sweep("slurm", size, {"--engine", "slurm", "--threads", "1"}, slurm->Environment());
      add("`slurm`, one node of two processors", run, HaveSameResults(run.out, local.out));
    } else {
      table.rows.push_back({fmt::format("`slurm`: not measured, {}", why_not), "-", "-", "-", "-", "-"});
    }
    // The folder of `local` has all cells already.
    const MeasuredSweep kept = Sweep("local", size, {"--threads", "2"});
    add("`local`, all cells kept", kept, kept.cells_from_before == kept.cells && kept.hulls == 0);
    Write("engines", table);
    MeasureChange(size, kept);
  }

  void WriteStore() const {
    const double sessions = sizes_.back(), frames = static_cast<double>(FramesOf(sizes_.back()));
    const CellStore store = StoreIn(cells_.out);
    const reporting::Table table{
        {"", "bytes", "a frame"},
        {{"a session's file", fmt::format("{:.0f}", BytesOf(sizes_.back()) / sessions),
          fmt::format("{:.0f}", BytesOf(sizes_.back()) / frames)},
         {"a session's cells (eight gaps; three parts, two revisions)",
          fmt::format("{:.0f}", static_cast<double>(store.bytes) / sessions),
          fmt::format("{:.1f}", static_cast<double>(store.bytes) / frames)},
         {"a cell (a part in up to 256 frames at eight gaps)",
          fmt::format("{:.0f}", static_cast<double>(store.bytes) / static_cast<double>(cells_.cells)),
          fmt::format("{:.1f}", static_cast<double>(store.bytes) / static_cast<double>(cells_.cells) *
                                    sessions / frames)},
         {"a session's hulls, with `--keep-hulls`",
          fmt::format("{:.0f}", bytes_of_hulls_a_frame_ * frames / sessions),
          fmt::format("{:.0f}", bytes_of_hulls_a_frame_)}}};
    Write("store", table);
  }

  void WriteSite() const {
    const double frames = kHours * 3600.0 * kFramesASecond;
    const double terabytes =
        kTera * frames * BytesOf(sizes_.back()) / static_cast<double>(FramesOf(sizes_.back()));
    const CellStore store = StoreIn(cells_.out);
    const double bytes_a_cell = static_cast<double>(store.bytes) / static_cast<double>(cells_.cells);
    const double files = frames / kFramesOfACell,
                 cells = files * static_cast<double>(cells_.cells) / sizes_.back();
    const auto row = [](const std::string& what, double ms_a_frame, double of_frames) {
      const double core_hours = 1e-3 * ms_a_frame * of_frames / 3600.0;
      return std::vector<std::string>{what, fmt::format("{:.2f} ms a frame", ms_a_frame),
                                      fmt::format("{:.0f} core hours", core_hours),
                                      fmt::format("{:.1f} days", core_hours / kCores / 24.0),
                                      fmt::format("{:.0f} EUR", core_hours * kEuroACoreHour)};
    };
    const reporting::Table times{
        {"10,000 hours at 30 frames a second", "measured here", "one core", "100 cores",
         "at 0.05 EUR a core hour"},
        {row("a first sweep: eight gaps, three parts, two revisions", ms_a_frame_, frames),
         row("one more revision of a part", ms_a_frame_of_change_, frames)}};
    const reporting::Table places{
        {"10,000 hours at 30 frames a second", "size", "files", "a month at 20 EUR a TB"},
        {{"sessions", fmt::format("{:.1f} TB", terabytes), "one a trial",
          fmt::format("{:.0f} EUR", terabytes * kEuroATerabyteMonth)},
         {"hulls, if they are kept", fmt::format("{:.0f} TB", kTera * frames * bytes_of_hulls_a_frame_),
          fmt::format("{:.1f} million", kMega * files),
          fmt::format("{:.0f} EUR", kTera * frames * bytes_of_hulls_a_frame_ * kEuroATerabyteMonth)},
         {"cells of that sweep", fmt::format("{:.3f} TB", kTera * cells * bytes_a_cell),
          fmt::format("{:.1f} million", kMega * files),
          fmt::format("{:.2f} EUR", kTera * cells * bytes_a_cell * kEuroATerabyteMonth)}}};
    reporting::WriteSection(docs_ / "scale.md", "site",
                            reporting::ToMarkdown(times) + "\n" + reporting::ToMarkdown(places));
  }

  [[nodiscard]] const SimulatedCohort& cohort() const { return cohort_; }

 private:
  // One more revision in a folder that has all cells of the others.
  void MeasureChange(int size, const MeasuredSweep& kept) {
    std::vector<std::string> more = Revision(folder_.path(), "D", 1.1);
    more.insert(more.end(), {"--threads", "1"});
    const MeasuredSweep first = Sweep("change", size, {"--threads", "1"});
    const MeasuredSweep all_kept = Sweep("change", size, {"--threads", "1"});
    const MeasuredSweep changed = Sweep("change", size, more);
    const MeasuredSweep keeping = Sweep("hulls", size, {"--threads", "1", "--keep-hulls"});
    more.emplace_back("--keep-hulls");
    const MeasuredSweep changed_again = Sweep("hulls", size, more);
    if (changed_again.hulls != 0 || !HaveSameResults(changed.out, changed_again.out))
      throw core::Error(core::ErrorKind::kRange, "scale: kept hulls aren't those that would be made");
    bytes_of_hulls_a_frame_ = BytesIn(keeping.out / "hulls") / static_cast<double>(FramesOf(size));
    const auto frames = static_cast<double>(FramesOf(size));
    ms_a_frame_of_change_ = 1e3 * (changed.wall_s - all_kept.wall_s) / frames;
    const auto row = [&](const std::string& what, const MeasuredSweep& run) {
      return std::vector<std::string>{what,
                                      fmt::format("{:.1f}", run.wall_s),
                                      fmt::format("{:.2f}", 1e3 * run.wall_s / frames),
                                      std::to_string(run.cells),
                                      std::to_string(run.cells_from_before),
                                      std::to_string(run.hulls)};
    };
    const reporting::Table table{
        {"one core", "time, s", "ms a frame", "cells", "kept", "hulls made"},
        {row("first sweep, two revisions", first), row("the same again", all_kept),
         row("one more revision of payload A", changed), row("first sweep, with `--keep-hulls`", keeping),
         row("one more revision of payload A, likewise", changed_again)}};
    if (kept.hulls != 0)
      throw core::Error(core::ErrorKind::kRange, "scale: a sweep of kept cells made hulls");
    Write("change", table);
  }

  [[nodiscard]] MeasuredSweep Sweep(const std::string& out, int size, std::vector<std::string> more,
                                    const std::map<std::string, std::string>& environment = {}) const {
    fmt::print(stderr, "scale: {} sessions, {}\n", size, out);
    more.insert(more.end(), revisions_.begin(), revisions_.end());
    return MeasureSweep(program_, std::span(cohort_.sessions).first(static_cast<std::size_t>(size)),
                        folder_ / out, more, environment);
  }
  [[nodiscard]] std::int64_t FramesOf(int size) const {
    return Sum(std::span(cohort_.frames).first(static_cast<std::size_t>(size)));
  }
  [[nodiscard]] double BytesOf(int size) const {
    return static_cast<double>(Sum(std::span(cohort_.bytes).first(static_cast<std::size_t>(size))));
  }
  void Write(const std::string& section, const reporting::Table& table) const {
    reporting::WriteSection(
        docs_ / "scale.md", section,
        reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs_ / "..")));
  }

  const fs::path docs_, program_;
  std::vector<int> sizes_;
  const test_support::TemporaryFolder folder_;
  SimulatedCohort cohort_;
  std::vector<std::string> revisions_;
  MeasuredSweep cells_;  // of all sessions
  double ms_a_frame_ = 0.0, ms_a_frame_of_change_ = 0.0, bytes_of_hulls_a_frame_ = 0.0;
};

}  // namespace

void MeasureScale(const fs::path& docs, const fs::path& program, const std::vector<int>& sizes,
                  double session_s) {
  ScaleMeasurement scale(docs, program, sizes, session_s);
  scale.MeasureGrowth();
  scale.MeasureEngines();
  scale.WriteStore();
  scale.WriteSite();
  MeasureHullBounds(docs, scale.cohort());
}

}  // namespace elbowroom::accuracy
