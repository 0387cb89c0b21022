// Points that lie in columns and rows, as far as a picture shows them: grown from a few, and numbered.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "recon/boards/saddle_fit.h"

namespace elbowroom::recon {

struct LatticeCell {
  int column = 0;
  int row = 0;
  [[nodiscard]] bool operator==(const LatticeCell&) const = default;
  [[nodiscard]] bool operator<(const LatticeCell& other) const {
    return std::tie(column, row) < std::tie(other.column, other.row);
  }
};

struct LatticePoint {
  Eigen::Vector2d pixel;
  double sigma_px = 0.1;
  std::size_t candidate = 0;  // its place in the list that it was chosen from, if there is one
};

using PointLattice = std::map<LatticeCell, LatticePoint>;

// Where the neighbours of a cell say that it is; nothing where there are too few. From up to 16 points that
// are at most three cells away: a homography of six or more, else an affine map of three or more.
[[nodiscard]] std::optional<LocalLattice> PredictCell(const PointLattice& lattice, LatticeCell cell);

// Looks for the point of a cell near where it is predicted.
using CellTrial = std::function<std::optional<LatticePoint>(LatticeCell, const LocalLattice&)>;

// Adds the neighbours that `trial` finds until there are none. Each cell is tried twice, if more of its
// neighbours were found in between. False: more than `most_across` cells in a direction, which stops it.
[[nodiscard]] bool GrowLattice(PointLattice& lattice, int most_across, const CellTrial& trial);

struct LatticeNumbering {
  // For each cell of a board, the lattice's cell that takes its place; nothing where the point wasn't found.
  std::vector<std::optional<LatticeCell>> cells;
  bool axes_exchanged = false;  // the board's columns run along the lattice's rows
};

// All ways to lay `expected`, the cells of a whole board in their order, over a lattice by quarter turns,
// such that both reach equally far in each direction, no point is left over and at most a fifth is missing.
// An outer line of the lattice with less than half of its cells is taken off first.
[[nodiscard]] std::vector<LatticeNumbering> NumberLattice(const PointLattice& lattice,
                                                          const std::vector<LatticeCell>& expected);

// The cell of the first point that was found; NumberLattice gives no numbering without one.
[[nodiscard]] LatticeCell FirstFound(const LatticeNumbering& numbering);

// The one whose first point is nearest to the picture's upper left corner, by x + y. Nothing if there is
// none.
[[nodiscard]] std::optional<LatticeNumbering> FromUpperLeft(const std::vector<LatticeNumbering>& numberings,
                                                            const PointLattice& lattice);

}  // namespace elbowroom::recon
