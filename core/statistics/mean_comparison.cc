#include "core/statistics/mean_comparison.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace elbowroom::core {
namespace {

double BothTails(double t, double df) {
  const boost::math::students_t distribution(df);
  return std::min(2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(t))), 1.0);
}

}  // namespace

std::optional<MeanComparison> CompareMeans(const Summary& a, const Summary& b) {
  if (!a.sd || !b.sd) return std::nullopt;
  // Errors of the means, as shares of the larger one: their fourth powers neither overflow nor are lost.
  const double error_a = *a.sd / std::sqrt(static_cast<double>(a.n)),
               error_b = *b.sd / std::sqrt(static_cast<double>(b.n));
  const double larger = std::max(error_a, error_b);
  if (!(larger > 0.0)) return std::nullopt;
  const double share_a = std::pow(error_a / larger, 2.0), share_b = std::pow(error_b / larger, 2.0);
  const double both = share_a + share_b;
  MeanComparison result;
  result.t = (a.mean - b.mean) / larger / std::sqrt(both);
  result.df =
      both * both /
      (share_a * share_a / static_cast<double>(a.n - 1) + share_b * share_b / static_cast<double>(b.n - 1));
  result.p = BothTails(result.t, result.df);
  return result;
}

std::optional<MeanComparison> ComparePairs(std::span<const double> a, std::span<const double> b) {
  Require(a.size() == b.size(), "pairs have two values each");
  if (a.empty()) return std::nullopt;
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
  const Summary summary = Summarise(differences);
  if (!summary.sd || !(*summary.sd > 0.0)) return std::nullopt;
  MeanComparison result;
  result.t = summary.mean / *summary.sd * std::sqrt(static_cast<double>(summary.n));
  result.df = static_cast<double>(summary.n - 1);
  result.p = BothTails(result.t, result.df);
  return result;
}

}  // namespace elbowroom::core
