#include "recon/boards/marker_consensus.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr double kMostSides = 0.5;
constexpr std::size_t kNearestMarkers = 4;
constexpr int kRefits = 3;

Vector2d CenterOf(const std::array<Vector2d, 4>& corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

std::vector<PointPair> PairsOf(const PlacedMarker& marker) {
  std::vector<PointPair> pairs;
  for (std::size_t k = 0; k < 4; ++k)
    pairs.push_back({marker.on_board.corners_in_board[k], marker.in_picture.corners_px[k]});
  return pairs;
}

std::vector<PointPair> PairsOf(const std::vector<PlacedMarker>& markers) {
  std::vector<PointPair> pairs;
  for (const PlacedMarker& marker : markers) {
    const std::vector<PointPair> own = PairsOf(marker);
    pairs.insert(pairs.end(), own.begin(), own.end());
  }
  return pairs;
}

bool Explains(const Matrix3d& pixel_from_board, const PlacedMarker& marker) {
  double side_px = 0.0;
  const auto& corners = marker.in_picture.corners_px;
  for (std::size_t k = 0; k < 4; ++k) side_px += 0.25 * (corners[(k + 1) % 4] - corners[k]).norm();
  for (const PointPair& pair : PairsOf(marker))
    if (!((Map(pixel_from_board, pair.from) - pair.to).norm() <= kMostSides * side_px)) return false;
  return true;
}

std::vector<PlacedMarker> ExplainedBy(const Matrix3d& pixel_from_board, const std::vector<PlacedMarker>& placed) {
  std::map<int, PlacedMarker> by_id;
  for (const PlacedMarker& marker : placed)
    if (Explains(pixel_from_board, marker)) by_id.emplace(marker.on_board.id, marker);
  std::vector<PlacedMarker> explained;
  for (auto& [id, marker] : by_id) explained.push_back(marker);
  return explained;
}

// From one marker's homography, refitted to all that it explains.
std::vector<PlacedMarker> ConsensusFrom(const PlacedMarker& first, const std::vector<PlacedMarker>& placed,
                                        std::optional<Matrix3d>* pixel_from_board) {
  *pixel_from_board = FitHomography(PairsOf(first));
  if (!*pixel_from_board) return {};
  std::vector<PlacedMarker> agreeing{first};
  // A single marker's homography is only good near it, so what it explains grows from refit to refit.
  for (int i = 0; i < kRefits; ++i) {
    const std::vector<PlacedMarker> next = ExplainedBy(**pixel_from_board, placed);
    if (next.size() <= agreeing.size() && i > 0) break;
    if (next.empty()) break;
    const auto refitted = FitHomography(PairsOf(next));
    if (!refitted) break;
    agreeing = next;
    *pixel_from_board = refitted;
  }
  return agreeing;
}

// Markers in the picture where the board is that aren't among the agreeing ones.
std::size_t StrangersOnBoard(const Matrix3d& pixel_from_board, const std::vector<BoardMarker>& on_board,
                             const std::vector<PlacedMarker>& agreeing,
                             const std::vector<DetectedMarker>& in_picture) {
  Vector2d low = on_board.front().corners_in_board[0], high = low;
  for (const BoardMarker& marker : on_board) {
    for (const Vector2d& corner : marker.corners_in_board) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  // Markers beside the board speak against it too: a larger board is another board.
  const Vector2d margin = 0.25 * (high - low);
  const Matrix3d board_from_pixel = pixel_from_board.inverse();
  std::size_t strangers = 0;
  for (const DetectedMarker& marker : in_picture) {
    const Vector2d center = CenterOf(marker.corners_px);
    const Vector2d place = Map(board_from_pixel, center);
    if (!((place - (low - margin)).minCoeff() >= 0.0 && ((high + margin) - place).minCoeff() >= 0.0)) continue;
    const auto is_it = [&](const PlacedMarker& other) {
      return (CenterOf(other.in_picture.corners_px) - center).norm() < 1.0;
    };
    if (std::ranges::none_of(agreeing, is_it)) ++strangers;
  }
  return strangers;
}

}  // namespace

std::vector<PlacedMarker> AgreeingMarkers(const std::vector<BoardMarker>& on_board,
                                          const std::vector<DetectedMarker>& in_picture) {
  std::vector<PlacedMarker> placed;
  for (const DetectedMarker& marker : in_picture)
    if (static_cast<std::size_t>(marker.id) < on_board.size())
      placed.push_back({on_board[static_cast<std::size_t>(marker.id)], marker});
  std::vector<PlacedMarker> best;
  std::optional<Matrix3d> best_homography;
  for (const PlacedMarker& first : placed) {
    std::optional<Matrix3d> homography;
    std::vector<PlacedMarker> agreeing = ConsensusFrom(first, placed, &homography);
    if (agreeing.size() <= best.size()) continue;
    best = std::move(agreeing);
    best_homography = homography;
    if (best.size() == placed.size()) break;
  }
  if (best.empty() || 3 * StrangersOnBoard(*best_homography, on_board, best, in_picture) > best.size()) return {};
  return best;
}

std::optional<LocalLattice> PredictByMarkers(const std::vector<PlacedMarker>& markers,
                                             const Vector2d& x_in_board, double square_mm, double reach_mm) {
  std::vector<std::pair<double, std::size_t>> nearest;
  for (std::size_t i = 0; i < markers.size(); ++i)
    nearest.emplace_back((CenterOf(markers[i].on_board.corners_in_board) - x_in_board).norm(), i);
  std::ranges::sort(nearest);
  if (nearest.empty() || nearest.front().first > reach_mm) return std::nullopt;
  std::vector<PlacedMarker> used;
  for (std::size_t k = 0; k < std::min(kNearestMarkers, nearest.size()); ++k)
    used.push_back(markers[nearest[k].second]);
  const auto homography = FitHomography(PairsOf(used));
  if (!homography) return std::nullopt;
  LocalLattice local{Map(*homography, x_in_board), square_mm * MapDerivative(*homography, x_in_board)};
  local.pixel_from_squares.col(1) *= -1.0;  // rows run towards -y
  return local;
}

}  // namespace elbowroom::recon
