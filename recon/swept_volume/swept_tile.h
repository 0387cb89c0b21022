// A cube of cells in which swept volume is kept: the values at their corners, and how long each was covered.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "recon/swept_volume/cell_bound.h"
#include "recon/swept_volume/swept_grid.h"

namespace elbowroom::recon {

// What adding hulls asked, and what it could leave out.
struct SweptWork {
  std::int64_t balls = 0;          // ball queries of the whole hull
  std::int64_t bounded_cells = 0;  // cells for which planes were looked for
  std::int64_t covered_cells =
      0;  // cells for which they weren't, as all of the cell is in the volume already
  std::int64_t buried_cells =
      0;  // cells that weren't asked about at all: the volume's surface can't come there

  SweptWork& operator+=(const SweptWork& more) {
    balls += more.balls, bounded_cells += more.bounded_cells;
    covered_cells += more.covered_cells, buried_cells += more.buried_cells;
    return *this;
  }
};

inline constexpr int kTileCells = 16;                // on a side
inline constexpr int kTileCorners = kTileCells + 1;  // likewise

// A bit for each cell of a row along x; rows[y + 16 z].
using CellRows = std::array<std::uint16_t, kTileCells * kTileCells>;

class SweptTile {
 public:
  // The tile's first cell is `first` of the grid.
  SweptTile(const SweptGrid& grid, const GridCell& first);

  // Adds a hull that covers what it covers for `seconds`. `open`: the cameras that may exclude parts of the
  // tile.
  void Add(const VisualHull& hull, const UndecidedCameras& open, double seconds, SweptWork* work);

  // The value at one of its corners as far as its own cells lower it; Unset() where none did.
  [[nodiscard]] float Value(int x, int y, int z) const {
    return values_.empty() ? below_ : values_[CornerIndex(x, y, z)];
  }
  // How long one of its cells was covered.
  [[nodiscard]] double Seconds(int x, int y, int z) const;

  // The cells of which all corners are inside.
  [[nodiscard]] const CellRows& covered() const { return covered_; }
  [[nodiscard]] bool has_changed() const { return has_changed_; }  // since FindCovered()
  void FindCovered();

  // Sets the cells of which all neighbours are covered, too. Where all are, the memory is given back.
  void SetBuried(const CellRows& buried);
  [[nodiscard]] bool is_buried() const { return values_.empty(); }  // all of it

  [[nodiscard]] static float Unset(const SweptGrid& grid) {
    return static_cast<float>(16.0 * grid.DiagonalMm());
  }
  [[nodiscard]] static std::int64_t Bytes();

 private:
  static constexpr int kLevels = 5;  // cubes of 1, 2, 4, 8 and 16 cells
  [[nodiscard]] static std::size_t CornerIndex(int x, int y, int z) {
    return static_cast<std::size_t>(x + kTileCorners * (y + kTileCorners * z));
  }
  [[nodiscard]] static std::size_t NodeIndex(int level, int x, int y, int z);

  struct Visitor;
  void CoverNode(int level, const GridCell& node);
  void BoundCell(const GridCell& cell, const VisualHull& hull, const UndecidedCameras& open, SweptWork* work);
  [[nodiscard]] CornerLimits ValuesOf(const GridCell& cell) const;
  void Lower(int x, int y, int z, double limit_mm);

  const SweptGrid* grid_;
  GridCell first_;
  BoundOptions options_;
  float below_;                  // what a corner of a covered cell has at most
  std::vector<float> values_;    // by corner
  std::vector<double> seconds_;  // by node: the time added to all of its cells at once
  std::vector<bool> buried_;     // by node
  CellRows covered_{};
  bool has_changed_ = false;
};

}  // namespace elbowroom::recon
