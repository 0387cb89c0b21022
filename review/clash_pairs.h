// Which pairs of a layout's parts are judged, and by what rule.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/layout.h"

namespace elbowroom::review {

// Part names. All empty: every pair. `within`: both parts among these. `between` and `and_these`: one part
// among the first, the other among the second.
struct PairSelection {
  std::vector<std::string> within;
  std::vector<std::string> between;
  std::vector<std::string> and_these;
};

struct PairDemand {
  core::PartIndex a = 0;
  core::PartIndex b = 0;  // a < b
  double required_mm = 0.0;
  bool authorised_contact = false;
};

struct PairMatrix {
  std::vector<PairDemand> pairs;  // by a, then b
  std::int64_t ignored = 0;       // selected, but a rule says to ignore them
};

// The selected pairs with the layout's rules; a pair without one must keep `required_mm` apart.
// Throws: core::Error{kRange}: a name that no part has, only one side of between and and_these, within beside
// them, two rules for one pair, a rule of a part against itself, a required clearance that is negative or not
// finite.
[[nodiscard]] PairMatrix PairsOf(const core::Layout& layout, const PairSelection& selection = {},
                                 double required_mm = 0.0);

}  // namespace elbowroom::review
