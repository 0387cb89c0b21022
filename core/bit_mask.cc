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

void BitMask::SetAll() {
  std::fill(words_.begin(), words_.end(), ~std::uint64_t{0});
  const int past_last_word = width_px_ % 64;
  if (past_last_word == 0) return;
  const std::uint64_t last = (std::uint64_t{1} << static_cast<unsigned>(past_last_word)) - 1U;
  for (std::size_t i = words_per_row_ - 1; i < words_.size(); i += words_per_row_) words_[i] = last;
}

std::size_t BitMask::CountObjectPixels() const {
  std::size_t count = 0;
  // Most words are empty, and not every processor that this is compiled for counts bits.
  for (const std::uint64_t word : words_) {
    if (word != 0) count += static_cast<std::size_t>(std::popcount(word));
  }
  return count;
}

bool BitMask::ShowsObject() const {
  // Words are ORed block by block without a branch, which compilers turn into vector instructions.
  constexpr std::size_t kBlock = 64;
  std::size_t first = 0;
  for (; first + kBlock <= words_.size(); first += kBlock) {
    std::uint64_t any = 0;
    for (std::size_t i = first; i < first + kBlock; ++i) any |= words_[i];
    if (any != 0) return true;
  }
  return std::any_of(words_.begin() + static_cast<std::ptrdiff_t>(first), words_.end(),
                     [](std::uint64_t word) { return word != 0; });
}

}  // namespace elbowroom::core
