// Who asks the cells of a sweep: this process, or processes that GNU parallel or Slurm starts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>

#include "app/control/sweep/spacing_sweep.h"
#include "core/progress.h"

namespace elbowroom::control {

enum class SweepEngine { kLocal, kParallel, kSlurm };
[[nodiscard]] std::optional<SweepEngine> ParseSweepEngine(std::string_view text);  // "local", "parallel", ...
[[nodiscard]] std::string_view ToString(SweepEngine engine);

struct EngineOutcome {
  std::set<std::string> cells_before;  // names of those that were there before
  std::int64_t begun_again = 0;        // processes that were killed from outside, and begun again
};

// Has every cell of the request kept, by a process for each session, several at once, each with one thread
// (Slurm: with `threads`). One that is killed is begun again, and goes on from the cells that it kept; at
// most kMostAttempts times in all. Writes the commands and, for Slurm, the script of the array into the
// folder's `engine`. Then SweepSpacing finds all cells. kLocal: nothing is to be done.
// Throws: core::Error{kFile}: the engine's program isn't installed, a process failed (with its message);
// {kCancelled}: processes are ended, an array is cancelled.
inline constexpr int kMostAttempts = 3;
EngineOutcome RunSweepEngine(SweepEngine engine, const SweepRequest& request, int threads,
                             const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
