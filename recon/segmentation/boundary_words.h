// The words of a mask that hold boundary pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "core/bit_mask.h"

namespace elbowroom::recon {

// Pixels of row y: bit i is pixel x + i.
struct PixelWord {
  int x = 0;
  int y = 0;
  std::uint64_t bits = 0;
};

// Rows [begin, end) of a mask.
struct MaskRows {
  int begin = 0;
  int end = 0;
};

// The boundary pixels of these rows (core/soft_mask.h), word by word in the mask's order; words without any
// are left out. The same for every instruction set (tests/recon/segmentation/difference_kernel_test.cc).
[[nodiscard]] std::vector<PixelWord> BoundaryWords(const core::BitMask& mask, MaskRows rows);

}  // namespace elbowroom::recon
