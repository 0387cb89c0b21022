#include "core/bit_mask.h"

#include <algorithm>
#include <bit>

#include "core/error.h"

namespace elbowroom::core {

BitMask::BitMask(int width_px, int height_px) : width_px_(width_px), height_px_(height_px) {
  Require(width_px >= 0 && height_px >= 0, "a mask's size is not negative");
  words_per_row_ = (static_cast<std::size_t>(width_px) + 63U) / 64U;
  words_.assign(words_per_row_ * static_cast<std::size_t>(height_px), 0U);
}

std::size_t BitMask::CountObjectPixels() const {
  std::size_t count = 0;
  for (const std::uint64_t word : words_) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

bool BitMask::ShowsObject() const {
  return std::ranges::any_of(words_, [](std::uint64_t word) { return word != 0; });
}

}  // namespace elbowroom::core
