// Mann and Whitney's test against counting every choice, and against published figures.
#include "core/statistics/rank_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "tests/core/statistics/random_tables.h"

namespace elbowroom::core {
namespace {

// Pairs won by the first group, ties half.
double PairsWon(const std::vector<double>& a, const std::vector<double>& b) {
  double u = 0.0;
  for (const double x : a)
    for (const double y : b) u += x > y ? 1.0 : x == y ? 0.5 : 0.0;
  return u;
}

// Every way to call so many of the values the first group.
double TailsByCounting(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  const double u = PairsWon(a, b);
  double ways = 0.0, below = 0.0, above = 0.0;
  for (unsigned choice = 0; choice < (1U << all.size()); ++choice) {
    if (static_cast<std::size_t>(std::popcount(choice)) != a.size()) continue;
    std::vector<double> in, out;
    for (std::size_t i = 0; i < all.size(); ++i) ((choice >> i & 1U) != 0 ? in : out).push_back(all[i]);
    const double other = PairsWon(in, out);
    ways += 1.0;
    below += other <= u ? 1.0 : 0.0;
    above += other >= u ? 1.0 : 0.0;
  }
  return std::min(2.0 * std::min(below, above) / ways, 1.0);
}

TEST(CompareRanks, IsExactWithAndWithoutTies) {
  RandomTables random(3);
  for (int i = 0; i < 120; ++i) {
    const int n_a = random.Whole(1, 6), n_b = random.Whole(1, 6);
    const bool has_ties = i % 2 == 0;
    const auto a = has_ties ? random.Answers(n_a) : random.Group(n_a, 0.5, 1.0);
    const auto b = has_ties ? random.Answers(n_b) : random.Group(n_b, 0.0, 1.0);
    const auto found = CompareRanks(a, b);
    ASSERT_TRUE(found && found->is_exact);
    EXPECT_DOUBLE_EQ(found->u, PairsWon(a, b));
    EXPECT_NEAR(found->p, TailsByCounting(a, b), 1e-12) << i;
    EXPECT_NEAR(CompareRanks(b, a)->p, found->p, 1e-12);
  }
  EXPECT_FALSE(CompareRanks({}, std::vector{1.0}));
}

TEST(CompareRanks, GivesPublishedFigures) {
  // R's wilcox.test of the depression scale of Hollander and Wolfe (1973), 69f: W = 35, p = 0.1272 for the
  // alternative "greater", exact; both tails twice that.
  const std::vector<double> term{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
  const std::vector<double> weeks{1.15, 0.88, 0.90, 0.74, 1.21};
  const auto found = CompareRanks(term, weeks);
  EXPECT_EQ(found->u, 35.0);
  EXPECT_NEAR(found->p, 0.2544, 2e-4);
}

TEST(CompareRanks, TheNormalApproximationMeetsTheExactCountWhereItTakesOver) {
  RandomTables random(11);
  const auto a = random.Group(40, 0.0, 1.0), b = random.Group(21, 0.4, 1.0);
  const auto approximate = CompareRanks(a, b);
  EXPECT_FALSE(approximate->is_exact);
  const auto exact = CompareRanks(std::vector(a.begin(), a.end() - 1), b);
  EXPECT_TRUE(exact->is_exact);
  EXPECT_NEAR(approximate->p, exact->p, 0.05);
  const std::vector<double> same(40, 2.0);
  EXPECT_DOUBLE_EQ(CompareRanks(same, same)->p, 1.0);
}

}  // namespace
}  // namespace elbowroom::core
