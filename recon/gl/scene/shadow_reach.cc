#include "recon/gl/scene/shadow_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace elbowroom::recon::gl {
namespace {

using Blocks = std::array<std::array<bool, ShadowReach::kBlocks>, ShadowReach::kBlocks>;

// The block of a texel's edge, within the picture.
int BlockOf(float texel, int side_px) {
  const float block =
      std::floor(texel * static_cast<float>(ShadowReach::kBlocks) / static_cast<float>(side_px));
  return std::clamp(static_cast<int>(block), 0, ShadowReach::kBlocks - 1);
}

// Marks the blocks that a run of hits, [begin, end) of the row y, can reach.
void Mark(int begin, int end, int y, int side_px, Blocks& blocks) {
  const int left = BlockOf(static_cast<float>(begin) - kShadowFilterTexels, side_px),
            right = BlockOf(static_cast<float>(end) + kShadowFilterTexels, side_px),
            top = BlockOf(static_cast<float>(y) - kShadowFilterTexels, side_px),
            bottom = BlockOf(static_cast<float>(y + 1) + kShadowFilterTexels, side_px);
  for (int row = top; row <= bottom; ++row)
    std::fill(blocks[static_cast<std::size_t>(row)].begin() + left,
              blocks[static_cast<std::size_t>(row)].begin() + right + 1, true);
}

}  // namespace

ShadowReach::ShadowReach(const HullView& from_lamp) {
  const int side_px = from_lamp.width_px;
  Blocks blocks{};
  const float* row = from_lamp.depth_mm.data();
  const auto is_hit = [](float depth_mm) { return depth_mm > 0.0F; };
  for (int y = 0; y < from_lamp.height_px; ++y, row += side_px)
    for (const float* begin = std::find_if(row, row + side_px, is_hit); begin != row + side_px;) {
      const float* end = std::find_if_not(begin, row + side_px, is_hit);
      Mark(static_cast<int>(begin - row), static_cast<int>(end - row), y, side_px, blocks);
      begin = std::find_if(end, row + side_px, is_hit);
    }
  sums_.assign(static_cast<std::size_t>(kBlocks + 1) * (kBlocks + 1), 0);
  for (int y = 0; y < kBlocks; ++y)
    for (int x = 0; x < kBlocks; ++x)
      sums_[static_cast<std::size_t>((y + 1) * (kBlocks + 1) + x + 1)] =
          SumTo(x + 1, y) + SumTo(x, y + 1) - SumTo(x, y) +
          (blocks[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] ? 1 : 0);
}

int ShadowReach::SumTo(int x, int y) const { return sums_[static_cast<std::size_t>(y * (kBlocks + 1) + x)]; }

bool ShadowReach::Meets(const Eigen::AlignedBox2f& box) const {
  if (sums_.empty() || box.isEmpty()) return false;
  const Eigen::Array2f low = box.min().array() * static_cast<float>(kBlocks),
                       high = box.max().array() * static_cast<float>(kBlocks);
  if ((high < 0.0F).any() || (low > static_cast<float>(kBlocks)).any()) return false;
  const auto block = [](float at) { return std::clamp(static_cast<int>(std::floor(at)), 0, kBlocks - 1); };
  const int left = block(low.x()), right = block(high.x()) + 1, top = block(low.y()),
            bottom = block(high.y()) + 1;
  return SumTo(right, bottom) - SumTo(left, bottom) - SumTo(right, top) + SumTo(left, top) > 0;
}

}  // namespace elbowroom::recon::gl
