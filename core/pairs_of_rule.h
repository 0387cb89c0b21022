// Which pairs of parts a [[pair]] rule is for.
#pragma once

#include <set>
#include <utility>

#include "core/layout.h"

namespace elbowroom::core {

// The pairs of parts that a rule is for, each once and its lower index first.
struct PairsOfRule {
  std::set<std::pair<PartIndex, PartIndex>> pairs;
  int parts_named = 0;  // of its two names; of two rules for a pair, the one with more holds
};
[[nodiscard]] PairsOfRule PairsOf(const Layout& layout, const PairRule& rule);

}  // namespace elbowroom::core
