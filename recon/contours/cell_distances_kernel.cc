// Compiled once for each kind of processor; see Highway's foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "recon/contours/cell_distances_kernel.cc"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "recon/contours/cell_distances_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace elbowroom::recon::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Bytes = hn::CappedTag<std::uint8_t, 64>;
using Floats = hn::CappedTag<float, 16>;

void NearSquares(const std::uint8_t* squares, std::size_t width, std::uint8_t near, std::uint8_t* nearest) {
  const Bytes d;
  const auto far = hn::Set(d, static_cast<std::uint8_t>(near * near));
  for (std::size_t x = 0; x < width; x += hn::Lanes(d)) {
    const std::uint8_t* const here = squares + x;
    auto least = hn::LoadU(d, here);
    // All cells that these depend on. The three vectors overlap if they are longer than `near`.
    const auto all = hn::Min(least, hn::Min(hn::LoadU(d, here - near), hn::LoadU(d, here + near)));
    if (hn::Lanes(d) > near && hn::AllTrue(d, hn::Eq(all, far))) {
      hn::StoreU(far, d, nearest + x);
      continue;
    }
    for (std::size_t dx = 1; dx < near; ++dx) {
      const auto beside = hn::Min(hn::LoadU(d, here - dx), hn::LoadU(d, here + dx));
      least = hn::Min(least, hn::Add(beside, hn::Set(d, static_cast<std::uint8_t>(dx * dx))));
    }
    hn::StoreU(least, d, nearest + x);
  }
}

void NearestBlocks(const float* squares, std::size_t width, int block, float* nearest) {
  const Floats d;
  for (std::size_t x = 0; x < width; x += hn::Lanes(d)) {
    // Lanes past the end count as 0, so that they don't keep the loop going.
    auto least = hn::IfThenElseZero(hn::FirstN(d, width - x), hn::LoadU(d, squares + x));
    float gap = 1.0F;
    for (std::size_t dx = 1; dx < width; ++dx, gap += static_cast<float>(block)) {
      const auto across = hn::Set(d, gap * gap);
      // The gap alone is as far already, and gaps only grow.
      if (hn::AllTrue(d, hn::Le(least, across))) break;
      const auto beside = hn::Min(hn::LoadU(d, squares + x - dx), hn::LoadU(d, squares + x + dx));
      least = hn::Min(least, hn::Add(beside, across));
    }
    hn::StoreU(least, d, nearest + x);
  }
}

}  // namespace
}  // namespace elbowroom::recon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elbowroom::recon {

HWY_EXPORT(NearSquares);
HWY_EXPORT(NearestBlocks);

void NearSquaresInRow(const std::uint8_t* squares, std::size_t width, std::uint8_t near,
                      std::uint8_t* nearest) {
  HWY_DYNAMIC_DISPATCH(NearSquares)(squares, width, near, nearest);
}

void NearestBlocksInRow(const float* squares, std::size_t width, int block, float* nearest) {
  HWY_DYNAMIC_DISPATCH(NearestBlocks)(squares, width, block, nearest);
}

}  // namespace elbowroom::recon
#endif
