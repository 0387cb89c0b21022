#include "recon/boards/lattice_sighting.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "recon/boards/seen_plane.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// Points of a board that are all on one line don't say how it lies.
bool AreOnALine(const std::vector<Vector2d>& points) {
  Vector2d mean = Vector2d::Zero();
  for (const Vector2d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vector2d& point : points) spread += (point - mean) * (point - mean).transpose();
  const Eigen::Vector2d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues();
  return !(values[0] > 1e-6 * values[1]);
}

}  // namespace

void RefineLattice(PointLattice* lattice, const CellTrial& trial) {
  PointLattice refined;
  for (const auto& [cell, point] : *lattice) {
    std::optional<LocalLattice> local = PredictCell(*lattice, cell);
    if (!local) continue;
    local->pixel = point.pixel;
    if (const std::optional<LatticePoint> again = trial(cell, *local)) refined[cell] = *again;
  }
  *lattice = std::move(refined);
}

std::optional<BoardSighting> AgreeingSighting(std::vector<SightedPoint> points, const Board& board,
                                              const cv::Size& picture, double least_share) {
  const std::vector<Eigen::Vector3d> points_in_board = PointsOf(board);
  std::ranges::sort(points, {}, &SightedPoint::point);
  std::vector<PointPair> pairs;
  for (const SightedPoint& point : points)
    pairs.push_back({points_in_board[static_cast<std::size_t>(point.point)].head<2>(), point.pixel});
  const std::vector<std::size_t> agreeing =
      AgreeingPairs(pairs, board.square_mm, picture.width, picture.height);
  if (agreeing.size() < 4 ||
      static_cast<double>(agreeing.size()) < least_share * static_cast<double>(points.size()))
    return std::nullopt;
  BoardSighting sighting;
  std::vector<Vector2d> places;
  for (const std::size_t i : agreeing) {
    sighting.points.push_back(points[i]);
    places.push_back(pairs[i].from);
  }
  if (AreOnALine(places)) return std::nullopt;
  return sighting;
}

std::optional<BoardSighting> SightingOf(const PointLattice& lattice, const LatticeNumbering& numbering,
                                        const Board& board, const cv::Size& picture, double least_share) {
  std::vector<SightedPoint> points;
  for (std::size_t i = 0; i < numbering.cells.size(); ++i) {
    if (!numbering.cells[i]) continue;
    const auto found = lattice.find(*numbering.cells[i]);
    if (found == lattice.end()) continue;
    points.push_back({static_cast<int>(i), found->second.pixel, found->second.sigma_px});
  }
  if (points.size() < 4) return std::nullopt;
  return AgreeingSighting(std::move(points), board, picture, least_share);
}

}  // namespace elbowroom::recon
