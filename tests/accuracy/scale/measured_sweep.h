// Sweeps of a simulated cohort by the program itself, and what they cost.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace elbowroom::accuracy {

struct SimulatedCohort {
  std::vector<std::filesystem::path> sessions;
  std::vector<std::int64_t> frames;  // of each
  std::vector<std::int64_t> bytes;   // of each session's file
};

// One trial of the payload task each, by `simulate`; sessions that are there already stay.
// Throws: core::Error{kFile} with what the program said.
[[nodiscard]] SimulatedCohort SimulateCohort(const std::filesystem::path& program,
                                             const std::filesystem::path& folder, int participants,
                                             double seconds);

struct MeasuredSweep {
  std::filesystem::path out;
  double wall_s = 0.0;
  double processor_s = 0.0;  // of the program and of all that it started and waited for; not of Slurm's jobs
  std::int64_t peak_bytes = 0;  // resident, of the program itself
  std::int64_t cells = 0;
  std::int64_t cells_from_before = 0;
  std::int64_t hulls = 0;  // made by the program itself, not by an engine's processes
};

// `sweep` of these sessions at eight gaps against the recorded layout and `more` (revisions, threads,
// engine), into `out`. `environment`: set beside this process's own. Throws: core::Error{kFile} with what the
// program said.
[[nodiscard]] MeasuredSweep MeasureSweep(const std::filesystem::path& program,
                                         std::span<const std::filesystem::path> sessions,
                                         const std::filesystem::path& out,
                                         const std::vector<std::string>& more,
                                         const std::map<std::string, std::string>& environment = {});

// What both have in common is the same: their files of results, bit by bit, and the bytes of their cells.
[[nodiscard]] bool HaveSameResults(const std::filesystem::path& out, const std::filesystem::path& other);
// All cells of `out` are in `all`, which is of more sessions, with the same bytes.
[[nodiscard]] bool HasCellsOf(const std::filesystem::path& all, const std::filesystem::path& out);

// Of the files of cells, and how many there are.
struct CellStore {
  std::int64_t files = 0;
  std::int64_t bytes = 0;
};
[[nodiscard]] CellStore StoreIn(const std::filesystem::path& out);

}  // namespace elbowroom::accuracy
