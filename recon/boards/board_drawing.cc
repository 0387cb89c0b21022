#include "recon/boards/board_drawing.h"

#include "recon/boards/board_finder.h"
#include "recon/boards/marker_dictionary.h"

namespace elbowroom::recon {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

// Of a pitch. Circles of an asymmetric grid stand further apart, on diagonals.
constexpr double kCircleRadius = 0.25, kAsymmetricCircleRadius = 0.35;
constexpr double kMarginSquares = 0.5;

AlignedBox2d Square(const Vector2d& first_corner, double side_mm) {
  AlignedBox2d box(first_corner);
  box.extend(first_corner + Vector2d(side_mm, -side_mm));
  return box;
}

// Black squares of `columns` x `rows`, the first of which has its first corner at `first_corner`.
void AddSquares(const Vector2d& first_corner, int columns, int rows, double side_mm, bool is_first_black,
                BoardDrawing* drawing) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (((column + row) % 2 == 0) != is_first_black) continue;
      drawing->rectangles.push_back(Square(first_corner + side_mm * Vector2d(column, -row), side_mm));
    }
  }
}

// The dark modules of a marker, those of a row that touch in one rectangle.
void AddMarker(const BoardMarker& marker, const std::vector<std::vector<bool>>& pattern,
               BoardDrawing* drawing) {
  const Vector2d& first = marker.corners_in_board[0];
  const auto across = pattern.size();
  const double module_mm = (marker.corners_in_board[1] - first).norm() / static_cast<double>(across);
  for (std::size_t row = 0; row < across; ++row) {
    for (std::size_t column = 0; column < across; ++column) {
      if (pattern[row][column]) continue;
      std::size_t end = column;
      while (end < across && !pattern[row][end]) ++end;
      AlignedBox2d run(first + module_mm * Vector2d(static_cast<double>(column), -static_cast<double>(row)));
      run.extend(first + module_mm * Vector2d(static_cast<double>(end), -static_cast<double>(row + 1)));
      drawing->rectangles.push_back(run);
      column = end;
    }
  }
}

}  // namespace

BoardDrawing DrawBoard(const Board& board) {
  const BoardFinder checked(board);  // throws what a board that can't be found is wrong with
  BoardDrawing drawing;
  drawing.inverted = board.inverted;
  const double s = board.square_mm;
  if (board.kind == BoardKind::kChessboard)
    AddSquares({-s, s}, board.columns + 1, board.rows + 1, s, true, &drawing);
  if (board.kind == BoardKind::kCharuco) {
    const bool has_light_corner = board.layout == CharucoLayout::kLegacy && board.rows % 2 == 0;
    AddSquares({0.0, 0.0}, board.columns, board.rows, s, !has_light_corner, &drawing);
  }
  if (board.has_markers()) {
    const MarkerDictionary dictionary(board.dictionary);
    for (const BoardMarker& marker : MarkersOf(board))
      AddMarker(marker, dictionary.PatternOf(marker.id), &drawing);
  } else if (board.kind != BoardKind::kChessboard) {
    const double radius = s * (board.kind == BoardKind::kCircles ? kCircleRadius : kAsymmetricCircleRadius);
    for (const Eigen::Vector3d& point : PointsOf(board)) drawing.circles.push_back({point.head<2>(), radius});
  }
  for (const AlignedBox2d& box : drawing.rectangles) drawing.ground.extend(box);
  for (const DrawnCircle& circle : drawing.circles) {
    drawing.ground.extend(Vector2d(circle.center_in_board.array() - circle.radius_mm));
    drawing.ground.extend(Vector2d(circle.center_in_board.array() + circle.radius_mm));
  }
  const Vector2d margin = Vector2d::Constant(kMarginSquares * s);
  drawing.ground = AlignedBox2d(drawing.ground.min() - margin, drawing.ground.max() + margin);
  return drawing;
}

}  // namespace elbowroom::recon
