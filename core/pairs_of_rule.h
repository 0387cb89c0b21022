// Which parts a [[pair]] is for.
#pragma once

#include <set>
#include <utility>

#include "core/layout.h"

namespace elbowroom::core {

// The pairs of parts that a rule is for, each once and its lower index first.
struct PairsOfRule {
  std::set<std::pair<PartIndex, PartIndex>> pairs;
  int parts_named = 0;  // of its two names; the rule that names more parts holds for a pair
};
[[nodiscard]] PairsOfRule PairsOf(const Layout& layout, const PairRule& rule);

}  // namespace elbowroom::core
