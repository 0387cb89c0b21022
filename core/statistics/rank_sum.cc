#include "core/statistics/rank_sum.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

namespace elbowroom::core {
namespace {

struct Ranked {
  std::vector<int> doubled;  // mid-ranks from 1, twice, of all values in ascending order
  std::vector<bool> in_a;
  double ties = 0.0;  // sum of c^3 - c over values that occur c times
};

Ranked Rank(std::span<const double> a, std::span<const double> b) {
  struct Value {
    double value;
    bool in_a;
  };
  std::vector<Value> values;
  for (const double value : a) values.push_back({value, true});
  for (const double value : b) values.push_back({value, false});
  std::ranges::stable_sort(values, {}, &Value::value);
  Ranked ranked;
  for (std::size_t begin = 0; begin < values.size();) {
    std::size_t end = begin;
    while (end < values.size() && values[end].value == values[begin].value) ++end;
    const auto count = static_cast<double>(end - begin);
    ranked.ties += count * count * count - count;
    for (std::size_t i = begin; i < end; ++i) {
      ranked.doubled.push_back(static_cast<int>(begin + end + 1));
      ranked.in_a.push_back(values[i].in_a);
    }
    begin = end;
  }
  return ranked;
}

// Both tails of the sum of n_a of the doubled ranks, over all choices of so many.
double ExactBothTails(const Ranked& ranked, std::size_t n_a, int doubled_sum) {
  int most = 0;
  for (const int rank : ranked.doubled) most += rank;
  const auto sums = static_cast<std::size_t>(most) + 1;
  // choices[k][s]: ways to choose k of the ranks so far with the sum s.
  std::vector<std::vector<double>> choices(n_a + 1, std::vector<double>(sums, 0.0));
  choices[0][0] = 1.0;
  for (const int rank : ranked.doubled)
    for (std::size_t k = n_a; k > 0; --k)
      for (std::size_t s = static_cast<std::size_t>(rank); s < sums; ++s)
        choices[k][s] += choices[k - 1][s - static_cast<std::size_t>(rank)];
  double all = 0.0, below = 0.0, above = 0.0;
  for (std::size_t s = 0; s < sums; ++s) {
    const double ways = choices[n_a][s];
    all += ways;
    if (static_cast<int>(s) <= doubled_sum) below += ways;
    if (static_cast<int>(s) >= doubled_sum) above += ways;
  }
  return std::min(2.0 * std::min(below, above) / all, 1.0);
}

double NormalBothTails(const Ranked& ranked, double n_a, double n_b, double u) {
  const double n = n_a + n_b;
  const double variance = n_a * n_b / 12.0 * (n + 1.0 - ranked.ties / (n * (n - 1.0)));
  if (!(variance > 0.0)) return 1.0;
  const double apart = std::max(std::abs(u - 0.5 * n_a * n_b) - 0.5, 0.0);
  const boost::math::normal distribution;
  const double tail = boost::math::cdf(boost::math::complement(distribution, apart / std::sqrt(variance)));
  return std::min(2.0 * tail, 1.0);
}

}  // namespace

std::optional<RankSumTest> CompareRanks(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) return std::nullopt;
  const Ranked ranked = Rank(a, b);
  int doubled_sum = 0;
  for (std::size_t i = 0; i < ranked.doubled.size(); ++i)
    if (ranked.in_a[i]) doubled_sum += ranked.doubled[i];
  const auto n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
  RankSumTest result;
  result.u = 0.5 * doubled_sum - 0.5 * n_a * (n_a + 1.0);
  result.is_exact = a.size() + b.size() <= static_cast<std::size_t>(kExactValues);
  result.p = result.is_exact ? ExactBothTails(ranked, a.size(), doubled_sum)
                             : NormalBothTails(ranked, n_a, n_b, result.u);
  return result;
}

}  // namespace elbowroom::core
