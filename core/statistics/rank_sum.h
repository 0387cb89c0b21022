// Whether the values of one group tend to be larger than those of another.
#pragma once

#include <optional>
#include <span>

namespace elbowroom::core {

struct RankSumTest {
  double u = 0.0;  // pairs in which the value of the first group is the larger one; ties count half
  double p = 1.0;  // of a u as far from its mean, if both groups come from one population; both tails
  bool is_exact = true;
};

// Mann and Whitney's test. Up to kExactValues values together p is exact, with ties, too: every choice of
// that many of the values is counted, by the sums of their mid-ranks. Above, u is taken as normally
// distributed, with the variance that ties leave and a continuity correction of a half. Nothing where a group
// is empty.
// Source: H. B. Mann, D. R. Whitney, "On a test of whether one of two random variables is stochastically
// larger than the other", Annals of Mathematical Statistics 18, 1947.
inline constexpr int kExactValues = 60;
[[nodiscard]] std::optional<RankSumTest> CompareRanks(std::span<const double> a, std::span<const double> b);

}  // namespace elbowroom::core
