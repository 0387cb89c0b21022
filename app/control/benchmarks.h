// The quick benchmarks that the program runs on its user's machine.
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"

namespace elbowroom::control {

struct BenchmarkTiming {
  std::string what;  // "3 cameras, 640 x 480"
  double median_ms = 0.0;
  double fastest_ms = 0.0;
  int repetitions = 0;
};

struct BenchmarkKind {
  std::string_view name;  // "view"
  std::string_view what;  // one line
};

// All benchmarks, in the order in which they run. docs/performance.md has the whole comparison.
[[nodiscard]] std::span<const BenchmarkKind> Benchmarks();

// Times one benchmark on simulated hands, with inputs in memory: medians of kBenchmarkRepetitions runs after
// a warm-up, with as many threads as the caller lets TBB use. Throws: core::Error{kRange} for an unknown
// name, with the names that there are; core::Error{kCancelled}.
inline constexpr int kBenchmarkRepetitions = 31;
[[nodiscard]] std::vector<BenchmarkTiming> RunBenchmark(std::string_view name, const core::Progress& progress,
                                                        std::stop_token stop);

}  // namespace elbowroom::control
