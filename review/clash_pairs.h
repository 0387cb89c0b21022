// Which pairs of a layout's parts are judged, and by which rule.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/layout.h"

namespace elbowroom::review {

// A selection by part names. All three lists empty: every pair is selected. `within`: both parts of a pair
// are in it. `between` and `and_these`: one part is in the first, the other in the second.
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
  std::int64_t ignored = 0;       // selected pairs whose rule says to ignore them
};

// The selected pairs with the layout's rules; a pair without one must keep `required_mm` apart.
// Rules must name parts, not groups (core::WithPairsOfParts). Throws: core::Error{kRange}: a name that no
// part has, only one of `between` and `and_these`, `within` together with them, two rules for one pair, a
// rule of a part against itself, a required clearance that is negative or not finite.
[[nodiscard]] PairMatrix PairsOf(const core::Layout& layout, const PairSelection& selection = {},
                                 double required_mm = 0.0);

}  // namespace elbowroom::review
