// How certain a mean is, without a distribution.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/statistics/summary.h"

namespace elbowroom::core {

// The share of samples drawn with replacement whose mean lies below and above the interval is
// (1 - confidence) / 2 each, at most. Up to kAllDrawn values all samples are counted, each as often as it can
// be drawn; above, kDraws are drawn by a generator with that seed, the same on every machine. Nothing for one
// value. With few values the interval is too narrow: four values of a normal distribution have their mean in
// nine of ten intervals of 95 % at best (docs/studies.md). Throws: PreconditionError without values.
// Source: B. Efron, "Bootstrap methods: another look at the jackknife", Annals of Statistics 7, 1979.
inline constexpr int kAllDrawn = 7;
inline constexpr int kDraws = 20'000;
[[nodiscard]] std::optional<Interval> BootstrapMean(std::span<const double> values, double confidence,
                                                    std::uint64_t seed);

}  // namespace elbowroom::core
