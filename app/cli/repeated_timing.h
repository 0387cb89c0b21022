// time_ms as every command reports it.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>

namespace elbowroom::cli {

// Median of five runs after a warm-up, ms; `compute` has its inputs in memory.
template <typename Compute>
[[nodiscard]] double MedianTimeMs(const Compute& compute) {
  compute();
  std::array<double, 5> times_ms{};
  for (double& time_ms : times_ms) {
    const auto begin = std::chrono::steady_clock::now();
    compute();
    time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  }
  std::nth_element(times_ms.begin(), times_ms.begin() + 2, times_ms.end());
  return times_ms[2];
}

// If `is_timed`, computes as often as MedianTimeMs does and returns its time; otherwise computes once and
// returns 0.
template <typename Compute>
double ComputeAndTimeMs(bool is_timed, const Compute& compute) {
  if (is_timed) return MedianTimeMs(compute);
  compute();
  return 0.0;
}

}  // namespace elbowroom::cli
