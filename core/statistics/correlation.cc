#include "core/statistics/correlation.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "core/error.h"
#include "core/statistics/summary.h"

namespace elbowroom::core {

std::optional<Correlation> Correlate(std::span<const double> a, std::span<const double> b) {
  Require(a.size() == b.size(), "a correlation is of pairs");
  constexpr std::size_t kFewest = 3;
  if (a.size() < kFewest) return std::nullopt;
  const Summary of_a = Summarise(a), of_b = Summarise(b);
  if (!(*of_a.sd > 0.0) || !(*of_b.sd > 0.0)) return std::nullopt;
  double products = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    products += (a[i] - of_a.mean) / *of_a.sd * ((b[i] - of_b.mean) / *of_b.sd);
  Correlation result{a.size(), std::clamp(products / static_cast<double>(a.size() - 1), -1.0, 1.0), 1.0};
  // Both tails of t are the incomplete beta function of 1 - r^2: exact near |r| = 1, too, where t grows
  // beyond all bounds.
  const double free = (1.0 - std::abs(result.r)) * (1.0 + std::abs(result.r));
  result.p = boost::math::ibeta(0.5 * static_cast<double>(a.size() - 2), 0.5, free);
  return result;
}

}  // namespace elbowroom::core
