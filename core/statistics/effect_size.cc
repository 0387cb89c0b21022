#include "core/statistics/effect_size.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace elbowroom::core {

std::optional<double> EffectSize(const Summary& a, const Summary& b) {
  if (!a.sd || !b.sd) return std::nullopt;
  const double larger = std::max(*a.sd, *b.sd);
  if (!(larger > 0.0)) return std::nullopt;
  const auto more_a = static_cast<double>(a.n - 1), more_b = static_cast<double>(b.n - 1);
  const double m = more_a + more_b;
  const double pooled =
      std::sqrt((more_a * std::pow(*a.sd / larger, 2.0) + more_b * std::pow(*b.sd / larger, 2.0)) / m);
  const double unbiased = 1.0 / (boost::math::tgamma_delta_ratio(0.5 * (m - 1.0), 0.5) * std::sqrt(0.5 * m));
  return unbiased * ((a.mean - b.mean) / larger) / pooled;
}

}  // namespace elbowroom::core
