// How far each cell of a grid is from the nearest one that holds something.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace elbowroom::recon {

// Euclidean distances between cells' centres, in cells: lower bounds, short by at most 1/8 up to kNearCells;
// farther away by at most 6 along each axis, from blocks of 4 x 4 cells (contour_map_test).
class CellDistances {
 public:
  static constexpr int kNearCells = 11;

  CellDistances() = default;
  // Cell (x, y) is item i = y * width + x; it holds something where first[i] != first[i + 1].
  CellDistances(int width, int height, std::span<const std::uint32_t> first);

  [[nodiscard]] double LowerBound(int x, int y) const {
    const std::uint8_t eighths =
        near_eighths_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
    if (eighths < kNearCells * 8) return 0.125 * eighths;
    return blocks_[static_cast<std::size_t>(y / kBlock) * block_width_ +
                   static_cast<std::size_t>(x / kBlock)];
  }

  // Item by item in eighths of a cell, capped at kNearCells; LabelRaster::kBytesBehind more behind them.
  [[nodiscard]] std::span<const std::uint8_t> near_eighths() const { return near_eighths_; }

 private:
  static constexpr int kBlock = 4;
  void FillNear(std::span<const std::uint8_t> down);
  void FillBlocks(std::span<const std::uint32_t> first);

  std::size_t width_ = 0, height_ = 0;
  std::size_t block_width_ = 0, block_height_ = 0;
  std::vector<std::uint8_t> near_eighths_;  // kNearCells * 8: at least as far
  std::vector<float> blocks_;               // at least kNearCells
};

}  // namespace elbowroom::recon
