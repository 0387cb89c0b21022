#include "core/soft_mask.h"

#include <bit>
#include <cstddef>

#include "core/error.h"

namespace elbowroom::core {

BitMask BoundaryPixels(const BitMask& mask) {
  BitMask boundary(mask.width_px(), mask.height_px());
  const std::size_t words = mask.words_per_row();
  const auto height = static_cast<std::size_t>(mask.height_px());
  const std::uint64_t* in = mask.words().data();
  const unsigned used = static_cast<unsigned>(mask.width_px()) & 63U;
  const std::uint64_t last_mask = used == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << used) - 1;
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint64_t* row = in + y * words;
    const std::uint64_t* above = y > 0 ? row - words : row;
    const std::uint64_t* below = y + 1 < height ? row + words : row;
    for (std::size_t i = 0; i < words; ++i) {
      const bool is_last = i + 1 == words;
      // The first and the last column are their own neighbours.
      const std::uint64_t before = i > 0 ? row[i - 1] >> 63U : row[i] & 1U;
      const std::uint64_t left = (row[i] << 1U) | before;
      std::uint64_t right = (row[i] >> 1U) | (is_last ? 0 : row[i + 1] << 63U);
      if (is_last) {
        const unsigned top = used == 0 ? 63U : used - 1;
        right |= row[i] & (std::uint64_t{1} << top);
      }
      const std::uint64_t differs =
          (row[i] ^ left) | (row[i] ^ right) | (row[i] ^ above[i]) | (row[i] ^ below[i]);
      boundary.words()[y * words + i] = is_last ? differs & last_mask : differs;
    }
  }
  return boundary;
}

void SoftMask::Validate() const {
  if (levels.empty()) return;
  const BitMask boundary = BoundaryPixels(mask);
  Require(levels.size() == boundary.CountObjectPixels(), "a soft mask has one level a boundary pixel");
  std::size_t next = 0;
  for (std::size_t i = 0; i < boundary.words().size(); ++i) {
    for (std::uint64_t bits = boundary.words()[i]; bits != 0; bits &= bits - 1) {
      const bool is_object = ((mask.words()[i] >> static_cast<unsigned>(std::countr_zero(bits))) & 1U) != 0;
      Require((levels[next++] >= 128) == is_object, "a soft mask's levels agree with its bits");
    }
  }
}

}  // namespace elbowroom::core
