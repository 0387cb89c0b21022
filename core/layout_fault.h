// Why a layout can't be met, and which of its entries says so.
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
  std::string key;        // as LAYOUT.toml has it; empty: the entry as a whole
  std::string message;    // names the entry, and says what to do
};

// The first fault, or nothing: duplicate or unknown names, a part without a mesh or with a recovery that
// can't be used, an empty group, limits not in order, a spacing whose moving parts are also its reference,
// two spacings that move one part along one axis, circular spacings, a pair of a part and itself, two rules
// for one pair, a figure of what gives way or of a
// stream out of range.
[[nodiscard]] std::optional<LayoutFault> FindLayoutFault(const Layout& layout);

}  // namespace elbowroom::core
