// Layouts with pair rules: flat parts, curved ones, and many that move together.
#pragma once

#include <random>
#include <vector>

#include "core/layout.h"
#include "review/clash.h"
#include "tests/review/random_parts.h"

namespace elbowroom::control::testing {

// Parts of that kind, side by side along x in groups of two, at any rotation: the second group on a gap above
// the first, the third on one above the second, and so on; the last part stands alone beside them. A rule for
// each pair.
[[nodiscard]] core::Layout StackOf(std::vector<review::testing::PartKind> kinds, std::mt19937_64& random);

// A gap for each spacing, some of them those of `last`.
[[nodiscard]] std::vector<double> NextGaps(const core::Layout& layout, const std::vector<double>& last,
                                           std::mt19937_64& random);

// Judged anew, by a checker that has seen nothing before.
[[nodiscard]] review::ClashReport JudgedAnew(const core::Layout& layout, const std::vector<double>& gaps_mm);

// Same verdicts; distances and points but for rounding.
void ExpectSame(const std::vector<review::PairClash>& pairs, const std::vector<review::PairClash>& anew);

// "lower" and "upper" are boxes of 50 mm on the spacing "gap", initially 30 mm, and must keep 20 mm apart;
// "aside" stands 5 mm beside "lower", and must keep 2 mm from it.
[[nodiscard]] core::Layout ThreeBoxes();

}  // namespace elbowroom::control::testing
