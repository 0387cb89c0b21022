// Which pairs of parts a [[pair]] rule is for, and whether they keep it.
#pragma once

#include <set>
#include <utility>

#include "core/contact.h"
#include "core/layout.h"

namespace elbowroom::core {

// The pairs of parts that a rule is for, each once and its lower index first.
struct PairsOfRule {
  std::set<std::pair<PartIndex, PartIndex>> pairs;
  int parts_named = 0;  // of its two names; of two rules for a pair, the one with more holds
};
[[nodiscard]] PairsOfRule PairsOf(const Layout& layout, const PairRule& rule);

// Whether two parts of this verdict break their rule. Where that isn't certain they do.
[[nodiscard]] constexpr bool BreaksPairRule(Verdict verdict, bool authorised_contact) {
  return verdict != Verdict::kClear && !(verdict == Verdict::kContact && authorised_contact);
}

}  // namespace elbowroom::core
