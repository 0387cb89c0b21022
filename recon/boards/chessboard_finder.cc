#include "recon/boards/chessboard_finder.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "recon/boards/lattice_sighting.h"
#include "recon/boards/point_lattice.h"
#include "recon/boards/saddle_fit.h"
#include "recon/boards/saddle_points.h"
#include "recon/boards/square_colors.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kLevels = 3;
constexpr int kLargestFirstPx = 1600;  // larger pictures are looked at smaller first
constexpr int kMostSeeds = 40;         // that are grown, at one size
constexpr double kMostTurnedSine = 0.35;
constexpr double kLeastRightColors = 0.9;

// The directions of a saddle's two edges, where its level is that of the saddle itself.
std::array<Vector2d, 2> EdgesOf(const SaddlePoint& saddle) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> solver(saddle.curvature);
  const Vector2d down = solver.eigenvectors().col(0), up = solver.eigenvectors().col(1);
  const double along_down = std::sqrt(std::max(1e-12, solver.eigenvalues()[1]));
  const double along_up = std::sqrt(std::max(1e-12, -solver.eigenvalues()[0]));
  return {(along_down * down + along_up * up).normalized(), (along_down * down - along_up * up).normalized()};
}

double SineBetween(const Vector2d& a, const Vector2d& b) { return std::abs(a.x() * b.y() - a.y() * b.x()); }

// A saddle with a neighbour on both of its edges at least.
struct Seed {
  PointLattice lattice;  // pixels are those of the saddles
  LocalLattice local;
  int sign = 1;  // of the saddle in the middle, cell (0, 0)
};

class SeedSearch {
 public:
  explicit SeedSearch(const std::vector<SaddlePoint>& saddles) : saddles_(saddles) {
    for (const SaddlePoint& saddle : saddles) edges_.push_back(EdgesOf(saddle));
  }

  [[nodiscard]] std::optional<Seed> SeedAt(std::size_t i) const {
    const Vector2d& here = saddles_[i].pixel;
    std::array<Vector2d, 2> axes = edges_[i];
    if (axes[0].x() * axes[1].y() - axes[0].y() * axes[1].x() < 0.0) axes[1] = -axes[1];
    Seed seed;
    const Vector2d between = axes[0] + axes[1];
    seed.sign = between.dot(saddles_[i].curvature * between) > 0.0 ? 1 : -1;
    int found = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const std::size_t k = static_cast<std::size_t>(axis);
      const auto ahead = NearestAlong(i, axes[k], axes), behind = NearestAlong(i, -axes[k], axes);
      if (!ahead && !behind) return std::nullopt;
      const Vector2d step = ahead && behind ? Vector2d(0.5 * (saddles_[*ahead].pixel - saddles_[*behind].pixel))
                            : ahead         ? Vector2d(saddles_[*ahead].pixel - here)
                                            : Vector2d(here - saddles_[*behind].pixel);
      if (ahead && behind &&
          (saddles_[*ahead].pixel + saddles_[*behind].pixel - 2.0 * here).norm() > 0.5 * step.norm())
        return std::nullopt;
      seed.local.pixel_from_squares.col(axis) = step;
      const LatticeCell cell = axis == 0 ? LatticeCell{1, 0} : LatticeCell{0, 1};
      if (ahead) seed.lattice[cell] = {saddles_[*ahead].pixel, 1.0};
      if (behind) seed.lattice[{-cell.column, -cell.row}] = {saddles_[*behind].pixel, 1.0};
      found += (ahead ? 1 : 0) + (behind ? 1 : 0);
    }
    if (found < 3) return std::nullopt;
    seed.local.pixel = here;
    seed.lattice[{0, 0}] = {here, 1.0};
    return seed;
  }

 private:
  // The nearest saddle in a direction that has the same edges, light and dark exchanged.
  [[nodiscard]] std::optional<std::size_t> NearestAlong(std::size_t from, const Vector2d& direction,
                                                        const std::array<Vector2d, 2>& axes) const {
    std::optional<std::size_t> nearest;
    double nearest_px = 0.0;
    const Vector2d between = axes[0] + axes[1], across = axes[0] - axes[1];
    for (std::size_t j = 0; j < saddles_.size(); ++j) {
      const Vector2d offset = saddles_[j].pixel - saddles_[from].pixel;
      const double along = offset.dot(direction);
      if (j == from || along < 2.0 || (nearest && along >= nearest_px)) continue;
      if (SineBetween(offset, direction) > kMostTurnedSine * along) continue;
      const Matrix2d& curvature = saddles_[j].curvature;
      const Matrix2d& here = saddles_[from].curvature;
      if (between.dot(curvature * between) * between.dot(here * between) > 0.0) continue;
      if (across.dot(curvature * across) * across.dot(here * across) > 0.0) continue;
      nearest = j;
      nearest_px = along;
    }
    return nearest;
  }

  const std::vector<SaddlePoint>& saddles_;
  std::vector<std::array<Vector2d, 2>> edges_;
};

// The trial of a chessboard's cells.
CellTrial SaddleTrial(const cv::Mat& grey, int sign_at_origin) {
  return [&grey, sign_at_origin](LatticeCell cell, const LocalLattice& local) -> std::optional<LatticePoint> {
    const auto fit = FitSaddle(grey, local, {.sign = SignAt(cell, sign_at_origin)});
    if (!fit) return std::nullopt;
    return LatticePoint{fit->pixel, fit->sigma_px};
  };
}

// The seed's own points, each as FitSaddle has it; nothing unless its middle and two more are saddles.
bool RefineSeed(const cv::Mat& grey, Seed* seed) {
  const CellTrial trial = SaddleTrial(grey, seed->sign);
  PointLattice refined;
  for (const auto& [cell, point] : seed->lattice)
    if (const auto fit = trial(cell, {point.pixel, seed->local.pixel_from_squares})) refined[cell] = *fit;
  seed->lattice = std::move(refined);
  return seed->lattice.contains({0, 0}) && seed->lattice.size() >= 3;
}

// Boards look the same after half a turn, or the first square says which end is the first.
std::optional<LatticeNumbering> ChooseNumbering(const std::vector<LatticeNumbering>& numberings,
                                                const PointLattice& lattice, const Board& board, int sign) {
  const LatticeNumbering* chosen = nullptr;
  double least = 0.0;
  for (const LatticeNumbering& numbering : numberings) {
    const auto first =
        std::ranges::find_if(numbering.cells, [](const auto& cell) { return cell.has_value(); });
    const int place = static_cast<int>(first - numbering.cells.begin());
    const int steps = place % board.columns + place / board.columns;
    // A sign is that of one diagonal, and a quarter turn exchanges both.
    const bool is_other_diagonal = (steps % 2 != 0) != numbering.axes_exchanged;
    const int sign_of_first_point = is_other_diagonal ? -SignAt(**first, sign) : SignAt(**first, sign);
    if ((board.columns + board.rows) % 2 != 0 && sign_of_first_point > 0) continue;
    const double sum = lattice.at(**first).pixel.sum();
    if (chosen == nullptr || sum < least) {
      chosen = &numbering;
      least = sum;
    }
  }
  if (chosen == nullptr) return std::nullopt;
  return *chosen;
}

std::vector<LatticeCell> CellsOf(const Board& board) {
  std::vector<LatticeCell> cells;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) cells.push_back({column, row});
  return cells;
}

// The lattice that grows from a seed, if it is the board.
std::optional<BoardSighting> GrowBoard(const cv::Mat& grey, const Board& board, Seed seed,
                                       PointLattice* grown) {
  const CellTrial trial = SaddleTrial(grey, seed.sign);
  const int most_across = std::max(board.columns, board.rows) + 2;
  const bool is_bounded = GrowLattice(seed.lattice, most_across, trial);
  *grown = seed.lattice;
  if (!is_bounded) return std::nullopt;
  const std::vector<LatticeNumbering> numberings = NumberLattice(seed.lattice, CellsOf(board));
  const auto numbering = ChooseNumbering(numberings, seed.lattice, board, seed.sign);
  if (!numbering) return std::nullopt;
  RefineLattice(&seed.lattice, trial);
  if (ShareOfRightColors(grey, seed.lattice, seed.sign, true) < kLeastRightColors) return std::nullopt;
  return SightingOf(seed.lattice, *numbering, board, grey.size(), 0.8);
}

std::optional<BoardSighting> FindAmong(const cv::Mat& grey, const Board& board,
                                       const std::vector<SaddlePoint>& saddles) {
  const SeedSearch search(saddles);
  std::vector<Vector2d> taken;
  int seeds = 0;
  for (std::size_t i = 0; i < saddles.size() && seeds < kMostSeeds; ++i) {
    const auto is_taken = [&](const Vector2d& pixel) { return (pixel - saddles[i].pixel).norm() < 2.0; };
    if (std::ranges::any_of(taken, is_taken)) continue;
    std::optional<Seed> seed = search.SeedAt(i);
    if (!seed || !RefineSeed(grey, &*seed)) continue;
    ++seeds;
    PointLattice grown;
    if (auto sighting = GrowBoard(grey, board, std::move(*seed), &grown)) return sighting;
    for (const auto& [cell, point] : grown) taken.push_back(point.pixel);
  }
  return std::nullopt;
}

}  // namespace

std::optional<BoardSighting> FindChessboard(const cv::Mat& grey, const Board& board) {
  int first = 0;
  while ((std::max(grey.cols, grey.rows) >> first) > kLargestFirstPx) ++first;
  for (int halvings = first; halvings < first + kLevels; ++halvings)
    if (auto sighting = FindAmong(grey, board, FindSaddlePoints(grey, halvings))) return sighting;
  for (int halvings = first - 1; halvings >= 0; --halvings)
    if (auto sighting = FindAmong(grey, board, FindSaddlePoints(grey, halvings))) return sighting;
  return std::nullopt;
}

}  // namespace elbowroom::recon
