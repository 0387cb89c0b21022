#include "tests/accuracy/interleaved_timing.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>

namespace elbowroom::accuracy {
namespace {

double TimeMs(const std::function<void()>& job) {
  const auto begin = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

std::vector<Timing> TimeInTurns(std::span<const std::function<void()>> jobs, int threads,
                                const TimingEffort& effort) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  std::vector<int> wanted;
  for (const auto& job : jobs)
    wanted.push_back(TimeMs(job) > effort.slow_ms ? effort.slow_repetitions : effort.repetitions);
  std::vector<std::vector<double>> times_ms(jobs.size());
  for (int turn = 0; turn < effort.repetitions; ++turn) {
    for (std::size_t i = 0; i < jobs.size(); ++i)
      if (turn < wanted[i]) times_ms[i].push_back(TimeMs(jobs[i]));
  }
  std::vector<Timing> timings;
  for (std::vector<double>& times : times_ms) {
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    timings.push_back({*middle, static_cast<int>(times.size())});
  }
  return timings;
}

}  // namespace elbowroom::accuracy
