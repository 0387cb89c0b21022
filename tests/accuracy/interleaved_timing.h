// Times that can be compared: taken in turns, in one process.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace elbowroom::accuracy {

struct Timing {
  double median_ms = 0.0;
  int repetitions = 0;
};

struct TimingEffort {
  int repetitions = 31;
  int slow_repetitions = 7;  // of what takes longer than slow_ms
  double slow_ms = 400.0;
};

// Runs each job once to warm up and then all in turns, so that whatever else loads the machine loads all of
// them. `threads`: the most that TBB uses meanwhile.
[[nodiscard]] std::vector<Timing> TimeInTurns(std::span<const std::function<void()>> jobs, int threads,
                                              const TimingEffort& effort = {});

}  // namespace elbowroom::accuracy
