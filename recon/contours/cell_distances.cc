#include "recon/contours/cell_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/contours/cell_distances_kernel.h"

namespace elbowroom::recon {
namespace {

constexpr int kNear = CellDistances::kNearCells;
constexpr std::size_t kWrittenBehind = 64;
static_assert(kWrittenBehind >= ContourCellsView::kBytesBehind);

// Rows of numbers with a margin on both sides.
template <typename Number>
class Rows {
 public:
  Rows(std::size_t width, std::size_t height, std::size_t margin, Number value)
      : stride_(width + 2 * margin), margin_(margin), numbers_(stride_ * height, value) {}

  [[nodiscard]] Number* Row(std::size_t y) { return numbers_.data() + y * stride_ + margin_; }
  // The row and its margins.
  [[nodiscard]] std::span<Number> Whole(std::size_t y) {
    return std::span(numbers_).subspan(y * stride_, stride_);
  }

 private:
  std::size_t stride_, margin_;
  std::vector<Number> numbers_;
};

// Calls visit(x, y) for all holders, row by row.
template <typename Visit>
void ForEach(std::span<const std::uint32_t> holders, std::size_t width, const Visit& visit) {
  std::size_t y = 0, row_end = width;
  for (const std::uint32_t holder : holders) {
    while (holder >= row_end) ++y, row_end += width;
    visit(holder + width - row_end, y);
  }
}

}  // namespace

// Rows are written a little beyond their ends.
CellDistances::CellDistances(int width, int height)
    : width_(static_cast<std::size_t>(width)),
      height_(static_cast<std::size_t>(height)),
      block_width_((width_ + kBlock - 1) / kBlock),
      block_height_((height_ + kBlock - 1) / kBlock),
      near_squares_(std::make_unique_for_overwrite<std::uint8_t[]>(width_ * height_ + kWrittenBehind)),
      blocks_(block_width_ * block_height_ + kRowMargin) {}

CellDistances::CellDistances(int width, int height, std::span<const std::uint32_t> holders)
    : CellDistances(width, height) {
  FillNear(holders);
  FillBlocks(holders);
}

CellDistances::CellDistances(int width, int height, RawReader* reader) : CellDistances(width, height) {
  reader->Read(std::span(near_squares_.get(), width_ * height_));
  std::fill_n(near_squares_.get() + width_ * height_, kWrittenBehind, std::uint8_t{0});
  reader->Read(std::span(blocks_));
}

void CellDistances::Write(RawWriter* writer) const {
  writer->Add(std::span<const std::uint8_t>(near_squares_.get(), width_ * height_));
  writer->Add(std::span<const float>(blocks_));
}

void CellDistances::FillNear(std::span<const std::uint32_t> holders) {
  // Two squares together fit a byte.
  static_assert(2 * kNear * kNear <= 255);
  // Cells up or down to the nearest one that holds something, at most kNear.
  Rows<std::uint8_t> down(width_, height_, kRowMargin, kNear);
  ForEach(holders, width_, [&](std::size_t x, std::size_t y) { down.Row(y)[x] = 0; });
  const auto take_nearer = [](std::span<const std::uint8_t> beside, std::span<std::uint8_t> row) {
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = std::min(row[x], static_cast<std::uint8_t>(beside[x] + 1));
  };
  for (std::size_t y = 1; y < height_; ++y) take_nearer(down.Whole(y - 1), down.Whole(y));
  for (std::size_t y = height_ - 1; y-- > 0;) take_nearer(down.Whole(y + 1), down.Whole(y));
  for (std::size_t y = 0; y < height_; ++y) {
    for (std::uint8_t& cells : down.Whole(y)) cells = static_cast<std::uint8_t>(cells * cells);
    NearSquaresInRow(down.Row(y), width_, kNear, near_squares_.get() + y * width_);
  }
}

void CellDistances::FillBlocks(std::span<const std::uint32_t> holders) {
  // First down the columns of blocks, then along the rows. Blocks are few, so their distances need no cap.
  // Two cells whose blocks are n > 0 blocks apart along an axis are at least kBlock (n - 1) + 1 cells apart
  // along it.
  const auto far = static_cast<int>(block_width_ + block_height_);
  std::vector<int> down(block_width_ * block_height_, far);
  ForEach(holders, width_,
          [&](std::size_t x, std::size_t y) { down[y / kBlock * block_width_ + x / kBlock] = 0; });
  for (std::size_t i = block_width_; i < down.size(); ++i)
    down[i] = std::min(down[i], down[i - block_width_] + 1);
  for (std::size_t i = down.size() - block_width_; i-- > 0;)
    down[i] = std::min(down[i], down[i + block_width_] + 1);
  Rows<float> squares(block_width_, 1, block_width_ + kRowMargin, std::numeric_limits<float>::infinity());
  for (std::size_t y = 0; y < block_height_; ++y) {
    for (std::size_t x = 0; x < block_width_; ++x) {
      const int blocks = down[y * block_width_ + x];
      const auto gap = static_cast<float>(blocks > 0 ? (blocks - 1) * kBlock + 1 : 0);
      squares.Row(0)[x] = gap * gap;
    }
    NearestBlocksInRow(squares.Row(0), block_width_, kBlock, blocks_.data() + y * block_width_);
  }
  // LowerBound() reads these for cells that are at least kNear away. A little is taken off for the rounding
  // of the root.
  for (float& block : blocks_) block = std::max(std::sqrt(block) * (1.0F - 1e-6F), static_cast<float>(kNear));
}

}  // namespace elbowroom::recon
