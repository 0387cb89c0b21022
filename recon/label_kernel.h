// The inner loop of PointProjection::KeepByCells, eight points at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "recon/hull_blocks.h"

namespace elbowroom::recon {

inline constexpr int kBlockPoints = kBlockCells + 1;  // grid points on a side of a block

// A bit for each of a block's kBlockPoints^3 grid points, in groups of eight.
struct BlockBits {
  static constexpr std::size_t kRows = kBlockPoints * kBlockPoints;
  static constexpr std::size_t kFarGroups = (kRows + 7) / 8;
  static constexpr std::size_t kGroups = kRows + kFarGroups;
  // First the rows: group y + kBlockPoints * z, bit x, of x up to 7. Then the points of x = 8: bit
  // y + kBlockPoints * z, counted on from group to group.
  std::array<std::uint8_t, kGroups> groups{};

  // The grid point of a bit of a group.
  [[nodiscard]] static std::array<std::size_t, 3> PointOf(std::size_t group, std::size_t bit) {
    if (group < kRows) return {bit, group % kBlockPoints, group / kBlockPoints};
    const std::size_t row = 8 * (group - kRows) + bit;
    return {kBlockCells, row % kBlockPoints, row / kBlockPoints};
  }

  // The points (x, y, z), bit x each.
  [[nodiscard]] unsigned Row(int y, int z) const {
    const auto row = static_cast<std::size_t>(y + kBlockPoints * z);
    const unsigned far = groups[kRows + row / 8] >> (row % 8) & 1U;
    return groups[row] | far << 8U;
  }
};
static_assert(kBlockCells == 8, "a row of cells is a group of points");

// A block before a camera: x and y are in focal lengths of pixels, mm; z in mm.
struct BlockView {
  std::array<double, 3> origin{};                // of grid point (0, 0, 0)
  std::array<std::array<double, 3>, 3> steps{};  // along each axis
  std::array<double, 3> corner{};                // the block's, as a grid point
};

// LabelRaster, as the loop wants it.
struct RasterView {
  const std::uint8_t* labels = nullptr;
  double origin_x_px = 0.0;
  double origin_y_px = 0.0;
  double cells_per_px = 1.0;
  std::int32_t width = 0;
  std::int32_t height = 0;
};

// Clears the bits of points in cells of background; those in mixed cells stay, and are set in `mixed`. Groups
// without a bit aren't asked; returns how many were.
std::size_t LabelByCells(const BlockView& block, const RasterView& raster, BlockBits* bits, BlockBits* mixed);

}  // namespace elbowroom::recon
