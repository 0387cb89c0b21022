#include "recon/boards/tag_finder.h"

#include <utility>
#include <vector>

#include "recon/boards/edge_fit.h"
#include "recon/boards/lattice_sighting.h"
#include "recon/boards/marker_consensus.h"

namespace elbowroom::recon {
namespace {

constexpr double kLeastAgreeingCorners = 0.7;

// Twice: the detector's corners are off by a pixel, which matters to the window of a small tag.
std::optional<CornerFit> FitTwice(const cv::Mat& grey, const std::array<Eigen::Vector2d, 4>& corners,
                                  std::size_t k, int modules) {
  const Eigen::Vector2d &before = corners[(k + 3) % 4], &after = corners[(k + 1) % 4];
  const auto first = FitCorner(grey, corners[k], before, after, modules);
  if (!first) return std::nullopt;
  const auto second = FitCorner(grey, first->pixel, before, after, modules);
  return second ? second : first;
}

}  // namespace

std::optional<BoardSighting> FindTags(const cv::Mat& grey, const Board& board,
                                      const MarkerDictionary& dictionary) {
  const std::vector<BoardMarker> on_board = MarkersOf(board);
  const std::vector<PlacedMarker> markers = AgreeingMarkers(on_board, dictionary.Detect(grey));
  if (markers.size() < std::min<std::size_t>(2, on_board.size())) return std::nullopt;
  std::vector<SightedPoint> points;
  for (const PlacedMarker& marker : markers) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto fit = FitTwice(grey, marker.in_picture.corners_px, k, dictionary.modules_across());
      if (fit) points.push_back({4 * marker.on_board.id + static_cast<int>(k), fit->pixel, fit->sigma_px});
    }
  }
  if (points.size() < 4) return std::nullopt;
  return AgreeingSighting(std::move(points), board, grey.size(), kLeastAgreeingCorners);
}

}  // namespace elbowroom::recon
