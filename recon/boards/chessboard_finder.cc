#include "recon/boards/chessboard_finder.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
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
constexpr double kLeastRightColors = 0.9;

// A saddle with four neighbours around it.
struct Seed {
  PointLattice lattice;  // pixels are those of the saddles
  LocalLattice local;
  int sign = 1;  // of the saddle in the middle, cell (0, 0)
};

// Saddles opposite to each other around a third.
struct OppositePair {
  std::size_t ahead;
  std::size_t behind;
  Vector2d half;  // of the way from one to the other
};

class SeedSearch {
 public:
  explicit SeedSearch(const std::vector<SaddlePoint>& saddles) : saddles_(saddles) {}

  [[nodiscard]] std::optional<Seed> SeedAt(std::size_t i) const {
    std::vector<OppositePair> pairs = PairsAround(i);
    if (pairs.empty()) return std::nullopt;
    const OppositePair first = pairs.front();
    const auto second = std::ranges::find_if(pairs, [&first](const OppositePair& pair) {
      return SineBetween(pair.half, first.half) > kLeastSine;
    });
    if (second == pairs.end()) return std::nullopt;
    if (Cross(first.half, second->half) < 0.0) std::swap(second->ahead, second->behind), second->half *= -1.0;
    Seed seed;
    seed.local.pixel = saddles_[i].pixel;
    seed.local.pixel_from_squares << first.half, second->half;
    // The squares on both axes' sides lie along the diagonal.
    const Vector2d diagonal = first.half + second->half;
    seed.sign = diagonal.dot(saddles_[i].curvature * diagonal) > 0.0 ? 1 : -1;
    seed.lattice[{0, 0}] = {saddles_[i].pixel, 1.0};
    seed.lattice[{1, 0}] = {saddles_[first.ahead].pixel, 1.0};
    seed.lattice[{-1, 0}] = {saddles_[first.behind].pixel, 1.0};
    seed.lattice[{0, 1}] = {saddles_[second->ahead].pixel, 1.0};
    seed.lattice[{0, -1}] = {saddles_[second->behind].pixel, 1.0};
    return seed;
  }

 private:
  static constexpr std::size_t kNeighbours = 10;
  static constexpr double kLeastSine = 0.12;
  static constexpr double kMostUneven = 0.35;  // of the two ways from the middle, as a share of one

  static double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
  static double SineBetween(const Vector2d& a, const Vector2d& b) {
    return std::abs(Cross(a, b)) / (a.norm() * b.norm());
  }

  // The nearest saddles whose light and dark directions are those of saddle `i`, exchanged.
  [[nodiscard]] std::vector<std::size_t> NeighboursOf(std::size_t i) const {
    const Eigen::SelfAdjointEigenSolver<Matrix2d> solver(saddles_[i].curvature);
    const Vector2d dark = solver.eigenvectors().col(0), light = solver.eigenvectors().col(1);
    std::vector<std::pair<double, std::size_t>> nearest;
    for (std::size_t j = 0; j < saddles_.size(); ++j) {
      const Matrix2d& curvature = saddles_[j].curvature;
      if (j == i || light.dot(curvature * light) > 0.0 || dark.dot(curvature * dark) < 0.0) continue;
      nearest.emplace_back((saddles_[j].pixel - saddles_[i].pixel).squaredNorm(), j);
    }
    const std::size_t count = std::min(kNeighbours, nearest.size());
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
    std::vector<std::size_t> neighbours;
    for (std::size_t k = 0; k < count; ++k) neighbours.push_back(nearest[k].second);
    return neighbours;
  }

  // The shortest first.
  [[nodiscard]] std::vector<OppositePair> PairsAround(std::size_t i) const {
    const std::vector<std::size_t> neighbours = NeighboursOf(i);
    std::vector<OppositePair> pairs;
    for (std::size_t a = 0; a < neighbours.size(); ++a) {
      for (std::size_t b = a + 1; b < neighbours.size(); ++b) {
        const Vector2d &ahead = saddles_[neighbours[a]].pixel, &behind = saddles_[neighbours[b]].pixel;
        const Vector2d half = 0.5 * (ahead - behind);
        if ((ahead + behind - 2.0 * saddles_[i].pixel).norm() < kMostUneven * half.norm())
          pairs.push_back({neighbours[a], neighbours[b], half});
      }
    }
    std::ranges::sort(pairs, {}, [](const OppositePair& pair) { return pair.half.squaredNorm(); });
    return pairs;
  }

  const std::vector<SaddlePoint>& saddles_;
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
std::optional<LatticeNumbering> ChooseNumbering(std::vector<LatticeNumbering> numberings,
                                                const PointLattice& lattice, const Board& board, int sign) {
  if ((board.columns + board.rows) % 2 != 0) {
    std::erase_if(numberings, [&](const LatticeNumbering& numbering) {
      const auto first =
          std::ranges::find_if(numbering.cells, [](const auto& cell) { return cell.has_value(); });
      const int place = static_cast<int>(first - numbering.cells.begin());
      const int steps = place % board.columns + place / board.columns;
      // A sign is that of one diagonal, and a quarter turn exchanges both.
      const bool is_other_diagonal = (steps % 2 != 0) != numbering.axes_exchanged;
      const int sign_there = SignAt(FirstFound(numbering), sign);
      return (is_other_diagonal ? -sign_there : sign_there) > 0;
    });
  }
  return FromUpperLeft(numberings, lattice);
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
