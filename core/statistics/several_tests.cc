#include "core/statistics/several_tests.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace elbowroom::core {

std::vector<double> CorrectForSeveral(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p[i]; });
  std::vector<double> corrected(p.size());
  double largest = 0.0;  // a larger p never becomes the smaller one
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, p[order[i]] * static_cast<double>(order.size() - i));
    corrected[order[i]] = std::min(largest, 1.0);
  }
  return corrected;
}

}  // namespace elbowroom::core
