#include "recon/boards/tag_finder.h"

#include <algorithm>
#include <array>
#include <vector>

#include "recon/boards/edge_fit.h"
#include "recon/boards/lattice_sighting.h"
#include "recon/boards/marker_consensus.h"

namespace elbowroom::recon {
namespace {

constexpr double kLeastAgreeingCorners = 0.7;
constexpr double kTagReach = 2.2;  // in pitches, from a read tag's centre to a corner

// Twice: the detector's corners are off by a pixel, which matters to the window of a small tag.
std::optional<CornerFit> FitTwice(const cv::Mat& grey, const std::array<Eigen::Vector2d, 4>& corners,
                                  std::size_t k, int modules) {
  const Eigen::Vector2d &before = corners[(k + 3) % 4], &after = corners[(k + 1) % 4];
  const auto first = FitCorner(grey, corners[k], before, after, modules);
  if (!first) return std::nullopt;
  const auto second = FitCorner(grey, first->pixel, before, after, modules);
  return second ? second : first;
}

std::vector<SightedPoint> CornersOf(const cv::Mat& grey, int id,
                                    const std::array<Eigen::Vector2d, 4>& corners, int modules) {
  std::vector<SightedPoint> points;
  for (std::size_t k = 0; k < 4; ++k)
    if (const auto fit = FitTwice(grey, corners, k, modules))
      points.push_back({4 * id + static_cast<int>(k), fit->pixel, fit->sigma_px});
  return points;
}

// Where the tags around it say that a tag is; nothing far from all of them.
std::optional<std::array<Eigen::Vector2d, 4>> PredictCorners(const std::vector<PlacedMarker>& markers,
                                                             const BoardMarker& marker, const Board& board) {
  std::array<Eigen::Vector2d, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto local =
        PredictByMarkers(markers, marker.corners_in_board[k], board.square_mm, kTagReach * board.square_mm);
    if (!local) return std::nullopt;
    corners[k] = local->pixel;
  }
  return corners;
}

}  // namespace

std::optional<BoardSighting> FindTags(const cv::Mat& grey, const Board& board,
                                      const MarkerDictionary& dictionary) {
  const std::vector<BoardMarker> on_board = MarkersOf(board);
  const std::vector<PlacedMarker> markers = AgreeingMarkers(on_board, dictionary.Detect(grey));
  if (markers.size() < std::min<std::size_t>(2, on_board.size())) return std::nullopt;
  std::vector<SightedPoint> points;
  for (const BoardMarker& marker : on_board) {
    const auto read =
        std::ranges::find_if(markers, [&](const PlacedMarker& m) { return m.on_board.id == marker.id; });
    const auto corners = read != markers.end() ? std::optional(read->in_picture.corners_px)
                                               : PredictCorners(markers, marker, board);
    if (!corners) continue;
    const std::vector<SightedPoint> seen = CornersOf(grey, marker.id, *corners, dictionary.modules_across());
    // A tag whose number wasn't read counts only if all of its corners are there.
    if (read != markers.end() || seen.size() == 4) points.insert(points.end(), seen.begin(), seen.end());
  }
  if (points.size() < 4) return std::nullopt;
  return AgreeingSighting(std::move(points), board, grey.size(), kLeastAgreeingCorners);
}

}  // namespace elbowroom::recon
