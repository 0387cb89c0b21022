#include "recon/boards/point_lattice.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "recon/boards/homography.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kReachCells = 3;
constexpr std::size_t kMostNeighbours = 16;
constexpr std::size_t kLeastForHomography = 6;
constexpr int kMostTries = 2;
constexpr double kMostMissing = 0.2;
constexpr std::array<LatticeCell, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

LatticeCell Sum(LatticeCell a, LatticeCell b) { return {a.column + b.column, a.row + b.row}; }

// Positions relative to the cell, the nearest first.
std::vector<PointPair> NeighboursOf(const PointLattice& lattice, LatticeCell cell) {
  std::vector<PointPair> pairs;
  for (int row = -kReachCells; row <= kReachCells; ++row)
    for (int column = -kReachCells; column <= kReachCells; ++column)
      if (const auto found = lattice.find(Sum(cell, {column, row})); found != lattice.end())
        pairs.push_back({Vector2d(column, row), found->second.pixel});
  std::ranges::stable_sort(pairs, {}, [](const PointPair& pair) { return pair.from.squaredNorm(); });
  if (pairs.size() > kMostNeighbours) pairs.resize(kMostNeighbours);
  return pairs;
}

// Nearer points weigh more. Nothing if the points are on a line.
std::optional<LocalLattice> PredictAffine(const std::vector<PointPair>& pairs) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (const PointPair& pair : pairs) {
    const double distance2 = std::max(1.0, pair.from.squaredNorm());
    const Eigen::Vector3d row = pair.from.homogeneous();
    normal += row * row.transpose() / (distance2 * distance2);
    right += row * pair.to.transpose() / (distance2 * distance2);
  }
  if (!(std::abs(normal.determinant()) > 1e-6)) return std::nullopt;
  const Eigen::Matrix<double, 3, 2> solution = normal.inverse() * right;
  LocalLattice local;
  local.pixel_from_squares = solution.topRows<2>().transpose();
  local.pixel = solution.row(2).transpose();
  return local;
}

// The cells beside the lattice, those with most neighbours first.
std::vector<std::pair<int, LatticeCell>> CellsBeside(const PointLattice& lattice) {
  std::map<LatticeCell, int> neighbours;
  for (const auto& [cell, point] : lattice)
    for (const LatticeCell& side : kSides)
      if (const LatticeCell beside = Sum(cell, side); !lattice.contains(beside)) ++neighbours[beside];
  std::vector<std::pair<int, LatticeCell>> cells;
  for (const auto& [cell, count] : neighbours) cells.emplace_back(count, cell);
  std::ranges::stable_sort(cells, [](const auto& a, const auto& b) { return a.first > b.first; });
  return cells;
}

struct CellRange {
  LatticeCell first;
  LatticeCell last;
};

template <typename Cells, typename CellOf>
CellRange RangeOf(const Cells& cells, const CellOf& cell_of) {
  CellRange range{cell_of(*cells.begin()), cell_of(*cells.begin())};
  for (const auto& entry : cells) {
    const LatticeCell cell = cell_of(entry);
    range.first = {std::min(range.first.column, cell.column), std::min(range.first.row, cell.row)};
    range.last = {std::max(range.last.column, cell.column), std::max(range.last.row, cell.row)};
  }
  return range;
}

LatticeCell Same(const LatticeCell& cell) { return cell; }

// A quarter turn, `turns` times, that keeps right-handed axes so.
LatticeCell Turned(LatticeCell cell, int turns) {
  for (int i = 0; i < turns; ++i) cell = {-cell.row, cell.column};
  return cell;
}

// Takes off outer lines with less than half as many points as the board's shape has in its fullest line.
std::set<LatticeCell> WithoutRaggedLines(const PointLattice& lattice) {
  std::set<LatticeCell> cells;
  for (const auto& [cell, point] : lattice) cells.insert(cell);
  for (bool is_changed = true; is_changed && !cells.empty();) {
    is_changed = false;
    for (int LatticeCell::*along : {&LatticeCell::column, &LatticeCell::row}) {
      std::map<int, int> count;
      int most = 0;
      for (const LatticeCell& cell : cells) most = std::max(most, ++count[cell.*along]);
      for (const std::pair<const int, int>& of_line : {*count.begin(), *count.rbegin()}) {
        const int line = of_line.first;
        if (2 * of_line.second >= most) continue;
        std::erase_if(cells, [&](const LatticeCell& cell) { return cell.*along == line; });
        is_changed = true;
      }
      if (cells.empty()) break;
    }
  }
  return cells;
}

}  // namespace

std::optional<LocalLattice> PredictCell(const PointLattice& lattice, LatticeCell cell) {
  const std::vector<PointPair> pairs = NeighboursOf(lattice, cell);
  if (pairs.size() >= kLeastForHomography) {
    if (const auto homography = FitHomography(pairs)) {
      const Vector2d here = Vector2d::Zero();
      return LocalLattice{Map(*homography, here), MapDerivative(*homography, here)};
    }
  }
  if (pairs.size() < 3) return std::nullopt;
  return PredictAffine(pairs);
}

bool GrowLattice(PointLattice& lattice, int most_across, const CellTrial& trial) {
  std::map<LatticeCell, int> tries, neighbours_then;
  for (bool is_grown = true; is_grown;) {
    is_grown = false;
    for (const auto& [neighbours, cell] : CellsBeside(lattice)) {
      if (tries[cell] >= kMostTries || neighbours_then[cell] >= neighbours) continue;
      const std::optional<LocalLattice> local = PredictCell(lattice, cell);
      if (!local) continue;
      ++tries[cell];
      neighbours_then[cell] = neighbours;
      if (const std::optional<LatticePoint> point = trial(cell, *local)) {
        lattice.emplace(cell, *point);
        is_grown = true;
      }
    }
    const CellRange range = RangeOf(lattice, [](const auto& entry) { return entry.first; });
    if (range.last.column - range.first.column >= most_across ||
        range.last.row - range.first.row >= most_across)
      return false;
  }
  return true;
}

std::vector<LatticeNumbering> NumberLattice(const PointLattice& lattice,
                                            const std::vector<LatticeCell>& expected) {
  std::vector<LatticeNumbering> numberings;
  const std::set<LatticeCell> cells = WithoutRaggedLines(lattice);
  if (cells.empty()) return numberings;
  const CellRange board = RangeOf(expected, Same);
  for (int turns = 0; turns < 4; ++turns) {
    std::map<LatticeCell, LatticeCell> lattice_cell_at;  // by the turned cell
    for (const LatticeCell& cell : cells) lattice_cell_at[Turned(cell, turns)] = cell;
    const CellRange turned = RangeOf(lattice_cell_at, [](const auto& entry) { return entry.first; });
    const LatticeCell shift{turned.first.column - board.first.column, turned.first.row - board.first.row};
    if (Sum(board.last, shift) != turned.last) continue;
    LatticeNumbering numbering{{}, turns % 2 != 0};
    std::size_t found = 0;
    for (const LatticeCell& cell : expected) {
      const auto at = lattice_cell_at.find(Sum(cell, shift));
      const bool is_there = at != lattice_cell_at.end();
      numbering.cells.push_back(is_there ? std::optional(at->second) : std::nullopt);
      if (is_there) ++found;
    }
    const auto least = (1.0 - kMostMissing) * static_cast<double>(expected.size());
    if (found == cells.size() && static_cast<double>(found) >= least)
      numberings.push_back(std::move(numbering));
  }
  return numberings;
}

LatticeCell FirstFound(const LatticeNumbering& numbering) {
  return **std::ranges::find_if(numbering.cells, [](const auto& cell) { return cell.has_value(); });
}

std::optional<LatticeNumbering> FromUpperLeft(const std::vector<LatticeNumbering>& numberings,
                                              const PointLattice& lattice) {
  const auto nearest = std::ranges::min_element(numberings, {}, [&](const LatticeNumbering& numbering) {
    return lattice.at(FirstFound(numbering)).pixel.sum();
  });
  if (nearest == numberings.end()) return std::nullopt;
  return *nearest;
}

}  // namespace elbowroom::recon
