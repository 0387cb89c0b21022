// Whether two groups differ in their means.
#pragma once

#include <optional>
#include <span>

#include "core/statistics/summary.h"

namespace elbowroom::core {

struct MeanComparison {
  double t = 0.0;   // > 0: the mean of the first group is larger
  double df = 0.0;  // degrees of freedom, mostly no whole number
  double p = 1.0;   // of a |t| as large, if the means are equal; both tails
};

// Welch's t-test for unequal variances: t = (mean_a - mean_b) / sqrt(v_a + v_b) with v = sd^2 / n, and
// df = (v_a + v_b)^2 / (v_a^2 / (n_a - 1) + v_b^2 / (n_b - 1)), Welch and Satterthwaite's. Nothing where a
// group has fewer than two values, or none of the two varies.
// Source: B. L. Welch, "The generalization of 'Student's' problem when several different population variances
// are involved", Biometrika 34, 1947.
[[nodiscard]] std::optional<MeanComparison> CompareMeans(const Summary& a, const Summary& b);

// The same question for two measures of the same people: the t-test of the differences a - b. Nothing where
// there are fewer than two, or they don't vary. Throws: PreconditionError when the counts differ.
[[nodiscard]] std::optional<MeanComparison> ComparePairs(std::span<const double> a,
                                                         std::span<const double> b);

}  // namespace elbowroom::core
