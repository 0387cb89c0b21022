#include "core/soft_mask.h"

#include <bit>
#include <cstddef>

#include "core/error.h"

namespace elbowroom::core {
namespace {

// The last word's highest bit that is a pixel.
unsigned TopBit(const BitMask& mask) { return (static_cast<unsigned>(mask.width_px()) - 1) & 63U; }

// The boundary pixels of a word, given those above and below it. Defined here so that it is inlined.
inline std::uint64_t BoundaryBits(const std::uint64_t* row, std::uint64_t above, std::uint64_t below,
                                  std::size_t i, std::size_t words, unsigned top) {
  // The first and the last column are their own neighbours: the picture's border is no boundary.
  const std::uint64_t before = i > 0 ? row[i - 1] >> 63U : row[0] & 1U;
  const std::uint64_t after = i + 1 < words ? row[i + 1] << 63U : row[i] & (std::uint64_t{1} << top);
  if ((row[i] | above | below | before | after) == 0) return 0;  // true of most words
  const std::uint64_t left = (row[i] << 1U) | before, right = (row[i] >> 1U) | after;
  const std::uint64_t boundary = (row[i] ^ left) | (row[i] ^ right) | (row[i] ^ above) | (row[i] ^ below);
  // Clears the padding, which differs from its neighbour where the last pixel is object.
  return i + 1 == words ? boundary & ((std::uint64_t{2} << top) - 1) : boundary;
}

// Calls visit(index of the word, its boundary pixels) for each word with boundary pixels, in order, until it
// returns false.
template <typename Visit>
void VisitBoundary(const BitMask& mask, Visit visit) {
  const std::size_t words = mask.words_per_row();
  const auto height = static_cast<std::size_t>(mask.height_px());
  const std::uint64_t* in = mask.words().data();
  if (words == 0) return;
  const unsigned top = TopBit(mask);
  const auto shows_object = [&](std::size_t y) {
    std::uint64_t any = 0;
    for (std::size_t i = 0; y < height && i < words; ++i) any |= in[y * words + i];
    return any != 0;
  };
  bool is_above = false, is_here = false, is_below = shows_object(0);
  for (std::size_t y = 0; y < height; ++y) {
    is_above = is_here, is_here = is_below, is_below = shows_object(y + 1);
    if (!is_above && !is_here && !is_below) continue;  // true of most rows
    const std::uint64_t* row = in + y * words;
    const std::uint64_t* above = y > 0 ? row - words : row;
    const std::uint64_t* below = y + 1 < height ? row + words : row;
    for (std::size_t i = 0; i < words; ++i) {
      const std::uint64_t boundary = BoundaryBits(row, above[i], below[i], i, words, top);
      if (boundary != 0 && !visit(y * words + i, boundary)) return;
    }
  }
}

}  // namespace

BitMask BoundaryPixels(const BitMask& mask) {
  BitMask boundary(mask.width_px(), mask.height_px());
  std::uint64_t* const out = boundary.words().data();
  VisitBoundary(mask, [&](std::size_t i, std::uint64_t bits) {
    out[i] = bits;
    return true;
  });
  return boundary;
}

std::uint64_t BoundaryOfWord(const BitMask& mask, std::size_t y, std::size_t i) {
  const std::size_t words = mask.words_per_row();
  const std::uint64_t* row = mask.words().data() + y * words;
  const std::uint64_t above = y > 0 ? *(row + i - words) : row[i];
  const std::uint64_t below = y + 1 < static_cast<std::size_t>(mask.height_px()) ? row[i + words] : row[i];
  return BoundaryBits(row, above, below, i, words, TopBit(mask));
}

std::optional<std::string_view> SoftMask::BrokenRule() const {
  if (levels.empty()) return std::nullopt;
  auto level = levels.begin();
  bool is_short = false;
  unsigned disagrees = 0;
  VisitBoundary(mask, [&](std::size_t i, std::uint64_t bits) {
    const std::uint64_t object = mask.words()[i];
    for (; bits != 0 && level != levels.end(); bits &= bits - 1, ++level) {
      // A level of 128 or more, whose highest bit is set, is object.
      disagrees |= (*level >> 7U) ^ static_cast<unsigned>((object >> std::countr_zero(bits)) & 1U);
    }
    is_short = bits != 0;
    return !is_short;
  });
  if (is_short || level != levels.end()) return "a soft mask has one level a boundary pixel";
  if (disagrees != 0) return "a soft mask's levels agree with its bits";
  return std::nullopt;
}

void SoftMask::Validate() const {
  const std::optional<std::string_view> broken = BrokenRule();
  Require(!broken, broken.value_or(""));
}

}  // namespace elbowroom::core
