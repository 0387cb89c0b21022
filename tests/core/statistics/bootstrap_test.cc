// The bootstrap against drawing every sample one by one.
#include "core/statistics/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "tests/core/statistics/random_tables.h"

namespace elbowroom::core {
namespace {

constexpr double kConfidence = 0.95;

// All n^n samples in their order.
std::vector<double> AllMeans(const std::vector<double>& values) {
  std::vector<std::size_t> place(values.size(), 0);
  std::vector<double> means;
  while (true) {
    double sum = 0.0;
    for (const std::size_t i : place) sum += values[i];
    means.push_back(sum / static_cast<double>(values.size()));
    std::size_t digit = 0;
    while (digit < place.size() && ++place[digit] == values.size()) place[digit++] = 0;
    if (digit == place.size()) break;
  }
  std::ranges::sort(means);
  return means;
}

TEST(BootstrapMean, CountsEverySampleOfAFew) {
  RandomTables random(5);
  for (int n = 2; n <= 6; ++n) {
    const std::vector<double> values = random.Group(n, 50.0, 20.0);
    const std::vector<double> means = AllMeans(values);
    const auto found = BootstrapMean(values, kConfidence, 1);
    ASSERT_TRUE(found);
    const double tail = 0.5 * (1.0 - kConfidence) * static_cast<double>(means.size());
    const auto at = static_cast<std::size_t>(tail);
    EXPECT_NEAR(found->lower, means[at], 1e-9) << n;
    EXPECT_NEAR(found->upper, means[means.size() - 1 - at], 1e-9) << n;
  }
  EXPECT_FALSE(BootstrapMean(std::vector{1.0}, kConfidence, 1));
  EXPECT_THROW((void)BootstrapMean({}, kConfidence, 1), PreconditionError);
}

TEST(BootstrapMean, OfManyIsNearTheNormalIntervalAndTheSameAgain) {
  const std::vector<double> values = RandomTables(9).Group(200, 100.0, 30.0);
  const auto found = BootstrapMean(values, kConfidence, 17);
  const auto textbook = MeanInterval(Summarise(values), kConfidence);
  EXPECT_NEAR(found->lower, textbook->lower, 0.3);
  EXPECT_NEAR(found->upper, textbook->upper, 0.3);
  const auto again = BootstrapMean(values, kConfidence, 17);
  EXPECT_EQ(found->lower, again->lower);
  EXPECT_EQ(found->upper, again->upper);
}

}  // namespace
}  // namespace elbowroom::core
