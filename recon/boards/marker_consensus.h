// Which of the markers in a picture are those of a board, and where they say that the board is.
#pragma once

#include <optional>
#include <vector>

#include "recon/boards/board.h"
#include "recon/boards/homography.h"
#include "recon/boards/marker_dictionary.h"
#include "recon/boards/saddle_fit.h"

namespace elbowroom::recon {

struct PlacedMarker {
  BoardMarker on_board;
  DetectedMarker in_picture;
};

// The most markers that one homography explains, each corner to half of the marker's side. A wrong number is
// off by more than a side, a lens by less. Empty if there are none, or if other markers lie where the board
// is, more than an eighth as many: then it is another board. (ChArUco boards of the two layouts may share all
// numbers but each seventh.)
[[nodiscard]] std::vector<PlacedMarker> AgreeingMarkers(const std::vector<BoardMarker>& on_board,
                                                        const std::vector<DetectedMarker>& in_picture);

// Where a point of the board is by the homography of the nearest markers, and by how much a square goes
// there. Nothing: it is further than `reach_mm` from the centre of every marker.
[[nodiscard]] std::optional<LocalLattice> PredictByMarkers(const std::vector<PlacedMarker>& markers,
                                                           const Eigen::Vector2d& x_in_board,
                                                           double square_mm, double reach_mm);

}  // namespace elbowroom::recon
