// How far each cell of a grid is from the nearest one that holds something.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "recon/contours/contour_cells_view.h"
#include "recon/contours/raw_bytes.h"

namespace elbowroom::recon {

// Bounds of the Euclidean distances between cells' centres, in cells. They are exact up to kNearCells;
// farther away they come from blocks of 4 x 4 cells, and lower ones are short by at most 6 along each
// axis (contour_map_test).
class CellDistances {
 public:
  static constexpr int kNearCells = 11;

  CellDistances() = default;
  // Cell (x, y) is item y * width + x; `holders`: those that hold something, ascending.
  CellDistances(int width, int height, std::span<const std::uint32_t> holders);
  // Those that were written, of as many cells.
  CellDistances(int width, int height, RawReader* reader);
  void Write(RawWriter* writer) const;

  [[nodiscard]] double LowerBound(int x, int y) const {
    const std::uint8_t square =
        near_squares_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
    if (square < kNearCells * kNearCells) return std::sqrt(static_cast<double>(square));
    return blocks_[static_cast<std::size_t>(y / kBlock) * block_width_ +
                   static_cast<std::size_t>(x / kBlock)];
  }

  [[nodiscard]] double UpperBound(int x, int y) const { return UpperBoundFrom(LowerBound(x, y)); }
  [[nodiscard]] static double UpperBoundFrom(double lower_bound) {
    return lower_bound < kNearCells ? lower_bound : lower_bound * kUpwards + kShort;
  }

  // The squared distance of each cell, capped at kNearCells^2; ContourCellsView::kBytesBehind more bytes
  // follow.
  [[nodiscard]] std::span<const std::uint8_t> near_squares() const {
    return {near_squares_.get(), width_ * height_ + ContourCellsView::kBytesBehind};
  }

 private:
  static constexpr int kBlock = 4;
  static constexpr double kShort = 2.0 * (kBlock - 1) * 1.4142135623730952;  // two blocks' own sizes
  static constexpr double kUpwards = 1.0 + 2e-6;                             // for the roots' rounding
  CellDistances(int width, int height);                                      // empty arrays
  void FillNear(std::span<const std::uint32_t> holders);
  void FillBlocks(std::span<const std::uint32_t> holders);

  std::size_t width_ = 0, height_ = 0;
  std::size_t block_width_ = 0, block_height_ = 0;
  std::unique_ptr<std::uint8_t[]> near_squares_;  // kNearCells^2 means at least kNearCells away
  std::vector<float> blocks_;                     // at least kNearCells
};

}  // namespace elbowroom::recon
