// Why a layout can't be used, and which of its entries is at fault.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/layout.h"

namespace elbowroom::core {

enum class LayoutEntry { kPart, kGroup, kSpacing, kPair, kStream };

struct LayoutFault {
  LayoutEntry entry = LayoutEntry::kPart;
  std::size_t index = 0;  // of the entry, among its kind
  std::string key;        // as in LAYOUT.toml; empty: the entry as a whole
  std::string message;    // names the entry and, where that isn't obvious, what to do
};

// The first fault, or nothing. Faults are: empty, duplicate or unknown names; control characters in a part's
// name; a part without a mesh or with a recovery that can't be used; an empty group; limits not in order; a
// spacing whose moving parts are also its reference; two spacings that move one part along one axis; circular
// spacings; a pair of a part and itself; two rules for one pair; rules for more than 500,000 pairs; a number
// of a part that gives way or of a stream out of range.
[[nodiscard]] std::optional<LayoutFault> FindLayoutFault(const Layout& layout);

}  // namespace elbowroom::core
