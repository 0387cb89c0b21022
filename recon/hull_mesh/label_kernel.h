// Labels of a block's grid points by the cells that they fall in, eight points at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "recon/contours/contour_cells_view.h"
#include "recon/contours/contour_kernel.h"
#include "recon/hull_mesh/hull_blocks.h"

namespace elbowroom::recon {

inline constexpr int kBlockPoints = kBlockCells + 1;  // grid points on a side of a block

// A bit for each of a block's kBlockPoints^3 grid points, in groups of eight that the kernel labels together.
struct BlockBits {
  static constexpr std::size_t kRows = kBlockPoints * kBlockPoints;
  static constexpr std::size_t kFarGroups = (kRows + 7) / 8;
  static constexpr std::size_t kGroups = kRows + kFarGroups;
  // First the rows: group y + kBlockPoints * z, bit x, of x up to 7. Then the points of x = 8: bit
  // y + kBlockPoints * z, counted on from group to group.
  std::array<std::uint8_t, kGroups> groups{};

  // The grid points of the bits, 8 to a group.
  static constexpr std::array<std::array<std::uint8_t, 3>, 8 * kGroups> kPoints = [] {
    std::array<std::array<std::uint8_t, 3>, 8 * kGroups> points{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t row = i < 8 * kRows ? i / 8 : i - 8 * kRows, x = i < 8 * kRows ? i % 8 : kBlockCells;
      points[i] = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(row % kBlockPoints),
                   static_cast<std::uint8_t>(row / kBlockPoints)};
    }
    return points;
  }();

  [[nodiscard]] bool At(int x, int y, int z) const {
    const auto row = static_cast<std::size_t>(y + kBlockPoints * z);
    if (x < kBlockCells) return (groups[row] >> x & 1) != 0;
    return (groups[kRows + row / 8] >> (row % 8) & 1) != 0;
  }
};
static_assert(kBlockCells == 8, "a row of cells is a group of points");

// Bits of a block's rows of points along x: bit y + kBlockPoints * z.
struct RowBits {
  std::array<std::uint64_t, 2> words{};
};

// A block is cut into bars of 8 x 2 x 2 cells, which lie along x.
inline constexpr std::size_t kBarsOfSide = kBlockCells / 2, kBars = kBarsOfSide * kBarsOfSide;

// Bits of the bars that are all object, and all background: bit y + kBarsOfSide * z.
struct BarLabels {
  unsigned object = 0, background = 0;
};

// One camera's labels of the points of the block at `corner`, by the cells that they fall in. Works in
// float32. That is right, since the label of a cell that isn't mixed also holds for points up to kTouchCells
// beside it, and float32's error is less; where it might be more (a block that reaches behind the camera, or
// far from its axis) all points are mixed. Both steps return how many labels they asked.
class BlockInCells {
 public:
  // `cells` must outlive this.
  BlockInCells(const GridView& grid, const GridPoint& corner, const ContourCellsView& cells);

  // The first step: clears the bits of the points in bars that no edge reaches and that are background. Rows
  // in bars that no edge reaches aren't asked again.
  std::size_t LabelBars(BlockBits* bits);

  // The second step: clears the bits of those points that fall into cells of background. Points in mixed
  // cells keep their bits and are set in `mixed`, which must be empty: SettleMixed decides them. Groups
  // without a bit are skipped.
  std::size_t LabelRows(BlockBits* bits, BlockBits* mixed) const;

 private:
  const ContourCellsView& cells_;
  GridView view_;  // from the block's own corner, x and y in cells times z
  bool floats_will_do_ = false;
  RowBits rows_;  // that are still to be asked
};

}  // namespace elbowroom::recon
