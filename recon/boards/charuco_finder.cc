#include "recon/boards/charuco_finder.h"

#include <algorithm>
#include <vector>

#include "recon/boards/lattice_sighting.h"
#include "recon/boards/marker_consensus.h"
#include "recon/boards/point_lattice.h"
#include "recon/boards/square_colors.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;

// From a marker's centre to a corner that it tells of; the corners of its own square are 0.71 squares away.
constexpr double kMarkerReachSquares = 1.6;
constexpr double kLeastRightDarkSquares = 0.8;
constexpr double kLeastAgreeingShare = 0.7;

// Cell (0, 0) is the first inner corner. Its square before it on both axes is the board's first one.
int SignAtFirstCorner(const Board& board) {
  const bool has_light_corner = board.layout == CharucoLayout::kLegacy && board.rows % 2 == 0;
  return has_light_corner ? 1 : -1;
}

CellTrial CharucoTrial(const cv::Mat& grey, const Board& board) {
  const double empty_squares = 0.5 * (1.0 - board.marker_mm / board.square_mm);
  const int sign_at_origin = SignAtFirstCorner(board);
  return [&grey, columns = board.columns - 1, rows = board.rows - 1, empty_squares, sign_at_origin](
             LatticeCell cell, const LocalLattice& local) -> std::optional<LatticePoint> {
    if (cell.column < 0 || cell.row < 0 || cell.column >= columns || cell.row >= rows) return std::nullopt;
    const auto fit =
        FitSaddle(grey, local, {.sign = SignAt(cell, sign_at_origin), .empty_squares = empty_squares});
    if (!fit) return std::nullopt;
    return LatticePoint{fit->pixel, fit->sigma_px};
  };
}

PointLattice CornersNearMarkers(const Board& board, const std::vector<PlacedMarker>& markers,
                                const CellTrial& trial) {
  PointLattice lattice;
  for (int row = 0; row + 1 < board.rows; ++row) {
    for (int column = 0; column + 1 < board.columns; ++column) {
      const Vector2d x_in_board((column + 1) * board.square_mm, -(row + 1) * board.square_mm);
      const auto local =
          PredictByMarkers(markers, x_in_board, board.square_mm, kMarkerReachSquares * board.square_mm);
      if (!local) continue;
      if (const auto point = trial({column, row}, *local)) lattice[{column, row}] = *point;
    }
  }
  return lattice;
}

}  // namespace

std::optional<BoardSighting> FindCharuco(const cv::Mat& grey, const Board& board,
                                         const MarkerDictionary& dictionary) {
  const std::vector<PlacedMarker> markers = AgreeingMarkers(MarkersOf(board), dictionary.Detect(grey));
  if (markers.empty()) return std::nullopt;
  const CellTrial trial = CharucoTrial(grey, board);
  PointLattice lattice = CornersNearMarkers(board, markers, trial);
  if (lattice.size() < 3) return std::nullopt;
  (void)GrowLattice(lattice, std::max(board.columns, board.rows), trial);
  RefineLattice(&lattice, trial);
  if (ShareOfRightColors(grey, lattice, SignAtFirstCorner(board), false) < kLeastRightDarkSquares)
    return std::nullopt;
  LatticeNumbering numbering;
  for (int row = 0; row + 1 < board.rows; ++row)
    for (int column = 0; column + 1 < board.columns; ++column)
      numbering.cells.push_back(lattice.contains({column, row}) ? std::optional(LatticeCell{column, row})
                                                                : std::nullopt);
  return SightingOf(lattice, numbering, board, grey.size(), kLeastAgreeingShare);
}

}  // namespace elbowroom::recon
