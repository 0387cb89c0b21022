// How much two groups differ, in their own spread.
#pragma once

#include <optional>

#include "core/statistics/summary.h"

namespace elbowroom::core {

// Hedges' g: the difference of the means (a - b) in pooled standard deviations, with the exact factor
// J(n_a + n_b - 2) that takes the bias of small groups away, J(m) = Γ(m/2) / (sqrt(m/2) Γ((m-1)/2)).
// Nothing where a group has fewer than two values, or none of the two varies.
// Source: L. V. Hedges, "Distribution theory for Glass's estimator of effect size and related estimators",
// Journal of Educational Statistics 6, 1981.
[[nodiscard]] std::optional<double> EffectSize(const Summary& a, const Summary& b);

}  // namespace elbowroom::core
