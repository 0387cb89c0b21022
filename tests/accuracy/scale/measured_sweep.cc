#include "tests/accuracy/scale/measured_sweep.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "app/control/sweep/sweep_cells.h"
#include "core/error.h"
#include "tests/support/resident_memory.h"
#include "tests/support/run_program.h"
#include "tests/support/text_file.h"

namespace elbowroom::accuracy {
namespace {

namespace fs = std::filesystem;

constexpr double kTimeoutS = 6.0 * 3600.0;

// What all children of this process that have ended used, and theirs.
double ProcessorS() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

nlohmann::json RunForJson(const fs::path& program, std::vector<std::string> arguments,
                          test_support::RunOptions options) {
  options.timeout_s = kTimeoutS;
  arguments.emplace_back("--json");
  const auto run = test_support::RunProgram(program, arguments, options);
  if (run.exit_status != 0) throw core::Error(core::ErrorKind::kFile, run.err);
  return nlohmann::json::parse(run.out);
}

}  // namespace

SimulatedCohort SimulateCohort(const fs::path& program, const fs::path& folder, int participants,
                               double seconds) {
  const nlohmann::json said =
      RunForJson(program,
                 {"simulate", "payload", "--participants", std::to_string(participants), "--seconds",
                  fmt::format("{}", seconds), "--out", folder.string()},
                 {});
  SimulatedCohort cohort;
  for (const nlohmann::json& trial : said.at("trials")) {
    cohort.sessions.emplace_back(trial.at("session").get<std::string>());
    cohort.frames.push_back(trial.at("frames").get<std::int64_t>());
    cohort.bytes.push_back(static_cast<std::int64_t>(fs::file_size(cohort.sessions.back())));
  }
  return cohort;
}

MeasuredSweep MeasureSweep(const fs::path& program, std::span<const fs::path> sessions, const fs::path& out,
                           const std::vector<std::string>& more,
                           const std::map<std::string, std::string>& environment) {
  std::vector<std::string> arguments{"sweep"};
  for (const fs::path& session : sessions) arguments.push_back(session.string());
  arguments.insert(arguments.end(), {"--spacing", "payload_a_gap=120:400:40", "--out", out.string()});
  arguments.insert(arguments.end(), more.begin(), more.end());
  MeasuredSweep sweep;
  sweep.out = out;
  test_support::RunOptions options;
  options.environment = environment;
  options.while_running = [&sweep](int process) {
    while (const std::int64_t bytes = test_support::PeakResidentBytes(process)) {
      sweep.peak_bytes = std::max(sweep.peak_bytes, bytes);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  };
  const double before_s = ProcessorS();
  const auto begin = std::chrono::steady_clock::now();
  const nlohmann::json said = RunForJson(program, arguments, options);
  sweep.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  sweep.processor_s = ProcessorS() - before_s;
  sweep.cells = said.at("cells");
  sweep.cells_from_before = said.at("cells_from_before");
  sweep.hulls = said.at("hulls");
  return sweep;
}

bool HaveSameResults(const fs::path& out, const fs::path& other) {
  for (const char* file : {"sweep.csv", "sweep.svg", "revisions.csv", "revisions.html"})
    if (test_support::ReadText(out / file) != test_support::ReadText(other / file)) return false;
  return control::CellFilesIn(out) == control::CellFilesIn(other);  // their names are hashes of their bytes
}

bool HasCellsOf(const fs::path& all, const fs::path& out) {
  const std::set<std::string> many = control::CellFilesIn(all), few = control::CellFilesIn(out);
  return !few.empty() && std::ranges::includes(many, few);
}

CellStore StoreIn(const fs::path& out) {
  CellStore store;
  for (const std::string& file : control::CellFilesIn(out)) {
    ++store.files;
    store.bytes += static_cast<std::int64_t>(fs::file_size(control::CellsIn(out) / file));
  }
  return store;
}

}  // namespace elbowroom::accuracy
