#include "core/statistics/summary.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "core/error.h"

namespace elbowroom::core {

Summary Summarise(std::span<const double> values) {
  Require(!values.empty(), "a summary is of at least one value");
  const double largest =
      std::abs(*std::ranges::max_element(values, {}, [](double value) { return std::abs(value); }));
  if (largest == 0.0 || values.size() == 1)
    return {values.size(), values.front(), values.size() > 1 ? std::optional(0.0) : std::nullopt};
  // Twice over the values as shares of the largest: its square neither overflows nor is lost.
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value / largest;
  const double rough = sum / n;
  double squares = 0.0, left = 0.0;  // what rounding left of the mean
  for (const double value : values) {
    const double apart = value / largest - rough;
    left += apart;
    squares += apart * apart;
  }
  const double variance = std::max(squares - left * left / n, 0.0) / (n - 1.0);
  return {values.size(), largest * (rough + left / n), largest * std::sqrt(variance)};
}

std::optional<Interval> MeanInterval(const Summary& summary, double confidence) {
  Require(confidence > 0.0 && confidence < 1.0, "a confidence is between 0 and 1");
  if (!summary.sd) return std::nullopt;
  const boost::math::students_t distribution(static_cast<double>(summary.n - 1));
  const double times = boost::math::quantile(boost::math::complement(distribution, 0.5 * (1.0 - confidence)));
  const double half = times * *summary.sd / std::sqrt(static_cast<double>(summary.n));
  return Interval{summary.mean - half, summary.mean + half};
}

}  // namespace elbowroom::core
