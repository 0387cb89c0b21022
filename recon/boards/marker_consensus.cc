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
constexpr std::size_t kMostForPairs = 12;
constexpr std::size_t kAgreeingPerStranger = 8;

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

std::vector<PlacedMarker> ExplainedBy(const Matrix3d& pixel_from_board,
                                      const std::vector<PlacedMarker>& placed) {
  std::map<int, PlacedMarker> by_id;
  for (const PlacedMarker& marker : placed)
    if (Explains(pixel_from_board, marker)) by_id.emplace(marker.on_board.id, marker);
  std::vector<PlacedMarker> explained;
  for (auto& [id, marker] : by_id) explained.push_back(marker);
  return explained;
}

struct Consensus {
  std::vector<PlacedMarker> markers;
  Matrix3d pixel_from_board;
};

// From the homography of one marker or two, refitted to all that it explains; replaces `best` if it has more.
void TryConsensus(const std::vector<PlacedMarker>& start, const std::vector<PlacedMarker>& placed,
                  Consensus* best) {
  std::optional<Matrix3d> homography = FitHomography(PairsOf(start));
  std::size_t explained = 0;
  // A single marker's homography is only good near it, so what it explains grows from refit to refit.
  for (int i = 0; i < kRefits && homography; ++i) {
    const std::vector<PlacedMarker> markers = ExplainedBy(*homography, placed);
    if (markers.size() <= explained) return;
    explained = markers.size();
    homography = FitHomography(PairsOf(markers));
    if (homography && explained > best->markers.size()) *best = {markers, *homography};
  }
}

Consensus FindConsensus(const std::vector<PlacedMarker>& placed) {
  Consensus best;
  for (std::size_t i = 0; i < placed.size() && best.markers.size() < placed.size(); ++i)
    TryConsensus({placed[i]}, placed, &best);
  // Few and damaged markers may agree only in pairs.
  if (placed.size() > kMostForPairs) return best;
  for (std::size_t i = 0; i < placed.size(); ++i)
    for (std::size_t j = i + 1; j < placed.size() && best.markers.size() < placed.size(); ++j)
      TryConsensus({placed[i], placed[j]}, placed, &best);
  return best;
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
    if (!((place - (low - margin)).minCoeff() >= 0.0 && ((high + margin) - place).minCoeff() >= 0.0))
      continue;
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
  Consensus best = FindConsensus(placed);
  if (best.markers.empty()) return {};
  const std::size_t strangers = StrangersOnBoard(best.pixel_from_board, on_board, best.markers, in_picture);
  if (kAgreeingPerStranger * strangers > best.markers.size()) return {};
  return best.markers;
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
