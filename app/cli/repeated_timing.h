// How long a command's computation takes, as its JSON says it.
#pragma once

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/system/kept_memory.h"

namespace elbowroom::cli {

struct RunTimes {
  double first_ms = 0.0;   // of the first call: memory is new, and nothing is in a cache
  double median_ms = 0.0;  // of the calls after it, at least five: memory is kept, as in a trial
};

// Times `compute`, which has its inputs in memory.
template <typename Compute>
[[nodiscard]] RunTimes TimeRuns(const Compute& compute) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kFewest = 5, kMost = 51;
  constexpr double kLongestMs = 100.0;  // beyond the fewest calls
  const auto timed_ms = [&] {
    const auto begin = Clock::now();
    compute();
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  };
  RunTimes times;
  times.first_ms = timed_ms();
  core::KeepFreedMemory();
  compute();
  std::vector<double> repeated_ms;
  double sum_ms = 0.0;
  while (repeated_ms.size() < kFewest || (repeated_ms.size() < kMost && sum_ms < kLongestMs)) {
    repeated_ms.push_back(timed_ms());
    sum_ms += repeated_ms.back();
  }
  const auto middle = repeated_ms.begin() + static_cast<std::ptrdiff_t>(repeated_ms.size() / 2);
  std::nth_element(repeated_ms.begin(), middle, repeated_ms.end());
  times.median_ms = *middle;
  return times;
}

// Computes; with `is_timed` (only --json prints times) as often as TimeRuns does.
template <typename Compute>
RunTimes ComputeAndTime(bool is_timed, const Compute& compute) {
  if (is_timed) return TimeRuns(compute);
  compute();
  return {};
}

inline void AddTimes(const RunTimes& times, nlohmann::json* json) {
  (*json)["time_ms"] = times.median_ms;
  (*json)["first_time_ms"] = times.first_ms;
}

}  // namespace elbowroom::cli
