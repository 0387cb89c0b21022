// Median, 95th percentile and maximum of many values.
#pragma once

#include <optional>
#include <vector>

namespace elbowroom::core {

struct Spread {
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

// The value below which `share` (0 to 1) of the sorted values lie, without interpolation. There must be a
// value.
[[nodiscard]] double PercentileOf(const std::vector<double>& sorted, double share);

// Nothing: no values. Their order doesn't matter.
[[nodiscard]] std::optional<Spread> SpreadOf(std::vector<double> values);

}  // namespace elbowroom::core
