// Welch's test, pairs, effect sizes, correlations and Holm's correction against other ways and published
// figures.
#include "core/statistics/mean_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/statistics/correlation.h"
#include "core/statistics/effect_size.h"
#include "core/statistics/several_tests.h"
#include "tests/core/statistics/random_tables.h"

namespace elbowroom::core {
namespace {

// Both tails of Student's t, without any special function: with x = sqrt(df) / tan(angle) its density is
// sin^(df - 1). Where df is below 2 that has no slope at 0, so the integrals are taken by the
// tanh-sinh rule, which doesn't mind.
double TailsByIntegral(double t, double df) {
  const auto integral = [&](double from, double to) {
    constexpr double kStep = 1.0 / 64.0;
    double sum = 0.0;
    for (int i = -4 * 64; i <= 4 * 64; ++i) {
      const double u = 0.5 * std::numbers::pi * std::sinh(i * kStep);
      const double share = 1.0 / (1.0 + std::exp(-2.0 * u));  // of the way from `from`, exact near it
      const double weight = std::cosh(i * kStep) / std::pow(std::cosh(u), 2.0);
      sum += weight * std::pow(std::sin(from + (to - from) * share), df - 1.0);
    }
    return 0.25 * std::numbers::pi * (to - from) * kStep * sum;
  };
  const double at = std::atan2(std::sqrt(df), std::abs(t));
  const double beyond = integral(0.0, at);
  return beyond / (beyond + integral(at, 0.5 * std::numbers::pi));
}

// Straight from the formula, in long double.
struct PlainWelch {
  double t = 0.0, df = 0.0;
  PlainWelch(const std::vector<double>& a, const std::vector<double>& b) {
    const auto mean = [](const std::vector<double>& values) {
      return std::accumulate(values.begin(), values.end(), 0.0L) / static_cast<long double>(values.size());
    };
    const auto error2 = [&](const std::vector<double>& values) {
      long double squares = 0.0L;
      for (const double value : values) squares += (value - mean(values)) * (value - mean(values));
      const auto n = static_cast<long double>(values.size());
      return squares / (n - 1.0L) / n;
    };
    const long double va = error2(a), vb = error2(b);
    t = static_cast<double>((mean(a) - mean(b)) / std::sqrt(va + vb));
    df = static_cast<double>((va + vb) * (va + vb) /
                             (va * va / static_cast<long double>(a.size() - 1) +
                              vb * vb / static_cast<long double>(b.size() - 1)));
  }
};

void ExpectNear(double value, double expected, double share, const char* what) {
  EXPECT_NEAR(value, expected, share * std::max(std::abs(expected), 1e-300)) << what;
}

TEST(CompareMeans, IsWelchsTestOnAThousandTables) {
  RandomTables random(20261127);
  for (int i = 0; i < 1000; ++i) {
    const double scale = std::pow(10.0, random.Number(-12.0, 12.0));
    const double middle = scale * random.Number(-3.0, 3.0);
    const auto a = random.Group(random.Whole(2, 40), middle, scale * random.Number(0.1, 2.0));
    const auto b = random.Group(random.Whole(2, 40), middle + scale * random.Number(-1.0, 1.0),
                                scale * random.Number(0.1, 2.0));
    SCOPED_TRACE(i);
    const auto found = CompareMeans(Summarise(a), Summarise(b));
    ASSERT_TRUE(found);
    const PlainWelch plain(a, b);
    ExpectNear(found->t, plain.t, 1e-11, "t");
    ExpectNear(found->df, plain.df, 1e-11, "df");
    EXPECT_NEAR(found->p, TailsByIntegral(plain.t, plain.df), 1e-9);
  }
}

// The published example of R's t.test: two drugs' extra hours of sleep (Student 1908).
const std::vector<double> kDrug1{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kDrug2{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(CompareMeans, GivesStudentsSleepData) {
  const auto found = CompareMeans(Summarise(kDrug1), Summarise(kDrug2));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->t, -1.8608, 5e-5);
  EXPECT_NEAR(found->df, 17.776, 5e-4);
  EXPECT_NEAR(found->p, 0.07939, 5e-6);
  const auto pairs = ComparePairs(kDrug1, kDrug2);
  ASSERT_TRUE(pairs);
  EXPECT_NEAR(pairs->t, -4.0621, 5e-5);
  EXPECT_EQ(pairs->df, 9.0);
  EXPECT_NEAR(pairs->p, 0.002833, 5e-7);
}

TEST(CompareMeans, IsSilentWhereNothingCanBeSaid) {
  const Summary one = Summarise(std::vector{3.0}), same = Summarise(std::vector{2.0, 2.0, 2.0}),
                varied = Summarise(std::vector{1.0, 2.0, 4.0});
  EXPECT_FALSE(CompareMeans(one, varied));
  EXPECT_FALSE(CompareMeans(varied, one));
  EXPECT_FALSE(CompareMeans(same, same));
  EXPECT_TRUE(CompareMeans(same, varied));
  EXPECT_FALSE(ComparePairs(std::vector{1.0, 2.0}, std::vector{2.0, 3.0}));
  EXPECT_FALSE(ComparePairs({}, {}));
  EXPECT_THROW((void)ComparePairs(std::vector{1.0}, {}), PreconditionError);
}

TEST(Summarise, KeepsItsDigitsFarFromZeroAndAtBothEndsOfTheRange) {
  // Differences of a tenth upon a billion: a sum of squares would have lost all of them.
  std::vector<double> far;
  for (int i = 0; i < 11; ++i) far.push_back(1e9 + 0.125 * i);
  EXPECT_DOUBLE_EQ(Summarise(far).mean, 1e9 + 0.625);
  EXPECT_NEAR(*Summarise(far).sd, 0.125 * std::sqrt(11.0), 1e-7);
  for (const double scale : {1e-300, 1e300}) {
    const Summary summary = Summarise(std::vector{1.0 * scale, 2.0 * scale, 3.0 * scale});
    ExpectNear(summary.mean, 2.0 * scale, 1e-15, "mean");
    ExpectNear(*summary.sd, scale, 1e-15, "sd");
  }
  EXPECT_EQ(Summarise(std::vector{0.0, 0.0}).sd, 0.0);
  EXPECT_FALSE(Summarise(std::vector{5.0}).sd);
  EXPECT_THROW((void)Summarise({}), PreconditionError);
}

TEST(MeanInterval, IsTheTextbooks) {
  // t(0.975, 3) = 3.182446, of any table.
  const auto interval = MeanInterval(Summarise(std::vector{1.0, 2.0, 3.0, 4.0}), 0.95);
  ASSERT_TRUE(interval);
  const double half = 3.182446 * std::sqrt(5.0 / 3.0) / 2.0;
  EXPECT_NEAR(interval->lower, 2.5 - half, 1e-6);
  EXPECT_NEAR(interval->upper, 2.5 + half, 1e-6);
  EXPECT_FALSE(MeanInterval(Summarise(std::vector{1.0}), 0.95));
}

TEST(EffectSize, IsTheDifferenceInUnbiasedStandardDeviations) {
  const Summary a = Summarise(std::vector{3.0, 5.0, 7.0, 9.0}), b = Summarise(std::vector{2.0, 4.0, 6.0});
  // Pooled variance (3 * 20/3 + 2 * 4) / 5 = 5.6; J(5) = 0.84075 of Hedges' table 1.
  EXPECT_NEAR(*EffectSize(a, b), 0.84075 * 2.0 / std::sqrt(5.6), 1e-5);
  EXPECT_FALSE(EffectSize(Summarise(std::vector{1.0}), b));
}

TEST(Correlate, AgreesWithTheTDistribution) {
  RandomTables random(7);
  for (int i = 0; i < 200; ++i) {
    const auto a = random.Group(random.Whole(3, 30), 0.0, 1.0);
    auto b = random.Group(static_cast<int>(a.size()), 0.0, 1.0);
    const double goes_along = random.Number(-2.0, 2.0);
    for (std::size_t k = 0; k < a.size(); ++k) b[k] += goes_along * a[k];
    const auto found = Correlate(a, b);
    ASSERT_TRUE(found);
    const double df = static_cast<double>(a.size()) - 2.0;
    const double t = found->r * std::sqrt(df / (1.0 - found->r * found->r));
    EXPECT_NEAR(found->p, TailsByIntegral(t, df), 1e-8) << "n " << a.size() << ", r " << found->r;
  }
  const auto exact = Correlate(std::vector{1.0, 2.0, 3.0}, std::vector{5.0, 3.0, 1.0});
  EXPECT_DOUBLE_EQ(exact->r, -1.0);
  EXPECT_NEAR(exact->p, 0.0, 1e-6);
  EXPECT_FALSE(Correlate(std::vector{1.0, 2.0}, std::vector{1.0, 2.0}));
  EXPECT_FALSE(Correlate(std::vector{1.0, 1.0, 1.0}, std::vector{1.0, 2.0, 3.0}));
}

TEST(CorrectForSeveral, IsHolms) {
  // 0.01 * 4, 0.013 * 3 raised to it, 0.04 * 2, 0.5.
  const std::vector<double> p{0.04, 0.01, 0.5, 0.013};
  const std::vector<double> expected{0.08, 0.04, 0.5, 0.04};
  const std::vector<double> found = CorrectForSeveral(p);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_DOUBLE_EQ(found[i], expected[i]);
  EXPECT_DOUBLE_EQ(CorrectForSeveral(std::vector{0.9, 0.8})[0], 1.0);
  EXPECT_TRUE(CorrectForSeveral({}).empty());
}

}  // namespace
}  // namespace elbowroom::core
