// The pairs of parts that a layout has rules for.
#pragma once

#include <vector>

#include "core/layout.h"
#include "review/clash.h"

namespace elbowroom::control {

// By a, then b. Rules that name groups stand for pairs of their parts; without a rule nothing is asked of two
// parts. Throws: core::Error{kRange} as review::PairsOf.
[[nodiscard]] std::vector<review::PairDemand> RuledPairsOf(const core::Layout& layout);

// Those of which one part moves against the other when the spacing changes: positions in `pairs`.
[[nodiscard]] std::vector<std::size_t> PairsMovedBy(const core::Layout& layout, core::SpacingIndex spacing,
                                                    const std::vector<review::PairDemand>& pairs);

}  // namespace elbowroom::control
