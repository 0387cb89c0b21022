// A silhouette whose boundary is known between pixel centres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/bit_mask.h"

namespace elbowroom::core {

// A mask, and how much of each pixel along its boundary is object.
//
// Boundary pixels have a neighbour in the picture, left, right, above or below, with the other label.
// `levels` holds one byte for each, row by row from the left: its coverage in 1/255, at least 128 where the
// mask says object, at most 127 where it says background. The boundary crosses the line between the centres
// of an object pixel a and a background pixel b at (a - 127.5) / (a - b) of the way. Empty: coverage isn't
// known, and the boundary is halfway, as for a ready mask.
struct SoftMask {
  BitMask mask;
  std::vector<std::uint8_t> levels;

  // Which of these rules the levels break. Nothing: none.
  [[nodiscard]] std::optional<std::string_view> BrokenRule() const;

  // Throws: PreconditionError when `levels` is neither empty nor one a boundary pixel, or contradicts the
  // mask.
  void Validate() const;
  [[nodiscard]] bool operator==(const SoftMask&) const = default;
};

// The boundary pixels of a mask, as bits.
[[nodiscard]] BitMask BoundaryPixels(const BitMask& mask);

// The same of one word: word `i` of row y.
[[nodiscard]] std::uint64_t BoundaryOfWord(const BitMask& mask, std::size_t y, std::size_t i);

}  // namespace elbowroom::core
