// Quantiles of what was measured.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace elbowroom::accuracy {

// The value below which a share of the values lies; 0 where there are none.
[[nodiscard]] inline double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace elbowroom::accuracy
