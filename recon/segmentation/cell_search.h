// Which cells of a picture must be compared pixel by pixel so that no large region is missed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace elbowroom::recon {

// A cell is 64 pixels of kCellRows rows below one another. In its first row all pixels are looked at, in the
// others pixels [kLookFromPx, kLookToPx).
inline constexpr int kCellRows = 4;
inline constexpr int kLookFromPx = 22, kLookToPx = 42;

// How a picture's cells are compared with the empty scene. `group` counts rows of cells, `word` their
// columns.
struct CellKernel {
  // Sets bit w if a pixel that is looked at in the cell of word w differs. Cells at the end of a row that
  // have fewer than 64 columns are left out.
  std::function<void(std::size_t group, std::uint64_t* bits)> look_at;
  // Writes a cell's differing pixels; true if there are any.
  std::function<bool(std::size_t group, std::size_t word)> differ_in;
};

// Compares all cells that can hold a pixel of an 8-connected region of `least_px` pixels or more, and returns
// how many pixels weren't looked at: none unless `least_px` is above 132 (docs/segmentation.md). The same
// for any number of threads.
std::int64_t SearchCells(std::size_t width_px, std::size_t height_px, const CellKernel& kernel, int least_px);

}  // namespace elbowroom::recon
