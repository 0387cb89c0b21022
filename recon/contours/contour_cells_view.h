// A contour laid over square cells: what the loops over many positions read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace elbowroom::recon {

// Positions in no cell are exterior, and so is all of cell 0. Cell (x, y) is item y * width + x.
struct ContourCellsView {
  static constexpr std::uint8_t kObject = 1;  // all of the cell
  static constexpr std::uint8_t kMixed = 2;   // edges touch it: the other bit is its centre's
  // An edge touches all cells that are this near to it, in cells. A position that is misplaced by less is
  // therefore still in a cell that lists the edge.
  static constexpr double kTouchCells = 1.0 / 64;
  // Items that follow the last one and can be read: a label is read together with the bytes behind it, and
  // edges are read four at a time, even where there are fewer.
  static constexpr std::size_t kBytesBehind = 3;
  static constexpr std::size_t kEdgesBehind = 4;

  struct Edge {
    double from_x, from_y, to_x, to_y;
  };

  double origin_x_px = 0.0, origin_y_px = 0.0;
  double cell_px = 1.0, cells_per_px = 1.0;
  std::int32_t width = 0, height = 0;
  std::span<const std::uint8_t> labels;
  // A lower bound of the squared distance from a cell's centre to that of the nearest mixed cell, in cells.
  std::span<const std::uint8_t> clear_squares;
  std::span<const std::uint32_t> first;  // of each cell's edges; one more at the end
  std::span<const Edge> edges;           // cell by cell
};

}  // namespace elbowroom::recon
