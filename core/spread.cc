#include "core/spread.h"

#include <algorithm>
#include <cstddef>

#include "core/error.h"

namespace elbowroom::core {

double PercentileOf(const std::vector<double>& sorted, double share) {
  Require(!sorted.empty() && share >= 0.0 && share <= 1.0, "a percentile is of values, and within 0 to 1");
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

std::optional<Spread> SpreadOf(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  return Spread{PercentileOf(values, 0.5), PercentileOf(values, 0.95), values.back()};
}

}  // namespace elbowroom::core
