// Mean and standard deviation of a few values.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace elbowroom::core {

// In the values' unit.
struct Summary {
  std::size_t n = 0;
  double mean = 0.0;
  std::optional<double> sd;  // of the sample, with n - 1; nothing for one value
};

struct Interval {
  double lower = 0.0;
  double upper = 0.0;
};

// The values are finite. They may be of any size: nothing overflows that the result doesn't.
// Throws: PreconditionError without values.
[[nodiscard]] Summary Summarise(std::span<const double> values);

// Where the mean of the values' population lies with that confidence (0 to 1), if they are normally
// distributed: mean -+ t sd / sqrt(n). Nothing without an sd.
[[nodiscard]] std::optional<Interval> MeanInterval(const Summary& summary, double confidence);

}  // namespace elbowroom::core
