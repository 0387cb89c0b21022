#include "recon/boards/board.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct NamedKind {
  BoardKind kind;
  std::string_view name;
};
constexpr NamedKind kKinds[] = {{BoardKind::kChessboard, "chessboard"},
                                {BoardKind::kCharuco, "charuco"},
                                {BoardKind::kAprilTags, "apriltag"},
                                {BoardKind::kCircles, "circles"},
                                {BoardKind::kAsymmetricCircles, "circles_asymmetric"}};

constexpr int kMostAcross = 200;
constexpr double kLargestMm = 10'000.0;

void Need(bool holds, std::string_view what) {
  if (!holds) throw core::Error(core::ErrorKind::kRange, fmt::format("the board: {}", what));
}

// The place of column c and row r, in print: rows run down.
Vector2d At(double column, double row, double pitch_mm) { return {column * pitch_mm, -row * pitch_mm}; }

// A marker's corners clockwise from its first one.
BoardMarker MarkerAt(int id, const Vector2d& first_corner, double side_mm) {
  BoardMarker marker{id, {}};
  marker.corners_in_board = {first_corner, first_corner + Vector2d(side_mm, 0.0),
                             first_corner + Vector2d(side_mm, -side_mm),
                             first_corner + Vector2d(0.0, -side_mm)};
  return marker;
}

bool HasMarker(const Board& board, int column, int row) {
  const bool has_white_corner = board.layout == CharucoLayout::kLegacy && board.rows % 2 == 0;
  return ((column + row) % 2 != 0) != has_white_corner;
}

}  // namespace

std::optional<BoardKind> ParseBoardKind(std::string_view text) {
  for (const NamedKind& named : kKinds)
    if (named.name == text) return named.kind;
  return std::nullopt;
}

std::string_view ToString(BoardKind kind) {
  for (const NamedKind& named : kKinds)
    if (named.kind == kind) return named.name;
  return "";
}

void Board::Validate() const {
  const bool is_board_of_squares = kind == BoardKind::kChessboard;
  const int least = kind == BoardKind::kAprilTags ? 1 : is_board_of_squares ? 3 : 2;
  Need(columns >= least && rows >= least && columns <= kMostAcross && rows <= kMostAcross,
       fmt::format("columns and rows are {} and {}; {} to {} are possible", columns, rows, least,
                   kMostAcross));
  const bool looks_the_same_on_both_axes = is_board_of_squares || kind == BoardKind::kCircles;
  Need(!looks_the_same_on_both_axes || columns != rows,
       "with as many columns as rows it looks the same after a quarter turn; take one row less");
  Need(std::isfinite(square_mm) && square_mm > 0.0 && square_mm <= kLargestMm,
       fmt::format("square_mm is {}; it must be more than 0 and at most {} mm", square_mm, kLargestMm));
  if (!has_markers()) return;
  Need(std::isfinite(marker_mm) && marker_mm > 0.0 && marker_mm < square_mm,
       fmt::format("marker_mm is {}; it must be more than 0 and less than square_mm, {}", marker_mm,
                   square_mm));
  Need(!dictionary.empty(), "a board with markers needs a dictionary, as \"DICT_6X6_250\"");
}

std::vector<Vector3d> PointsOf(const Board& board) {
  std::vector<Vector3d> points;
  const auto add = [&points](const Vector2d& at) { points.emplace_back(at.x(), at.y(), 0.0); };
  switch (board.kind) {
    case BoardKind::kChessboard:
    case BoardKind::kCircles:
      for (int row = 0; row < board.rows; ++row)
        for (int column = 0; column < board.columns; ++column) add(At(column, row, board.square_mm));
      break;
    case BoardKind::kAsymmetricCircles:
      for (int row = 0; row < board.rows; ++row)
        for (int column = 0; column < board.columns; ++column)
          add(At(2 * column + row % 2, row, board.square_mm));
      break;
    case BoardKind::kCharuco:
      for (int row = 1; row < board.rows; ++row)
        for (int column = 1; column < board.columns; ++column) add(At(column, row, board.square_mm));
      break;
    case BoardKind::kAprilTags:
      for (const BoardMarker& marker : MarkersOf(board))
        for (const Vector2d& corner : marker.corners_in_board) add(corner);
      break;
  }
  return points;
}

std::vector<BoardMarker> MarkersOf(const Board& board) {
  std::vector<BoardMarker> markers;
  if (!board.has_markers()) return markers;
  const bool is_charuco = board.kind == BoardKind::kCharuco;
  // A ChArUco marker stands in the middle of its square; tags stand at their pitch.
  const double inset_mm = is_charuco ? 0.5 * (board.square_mm - board.marker_mm) : 0.0;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      if (is_charuco && !HasMarker(board, column, row)) continue;
      const Vector2d corner = At(column, row, board.square_mm) + Vector2d(inset_mm, -inset_mm);
      markers.push_back(MarkerAt(static_cast<int>(markers.size()), corner, board.marker_mm));
    }
  }
  return markers;
}

std::optional<int> PointAfterHalfTurn(const Board& board, int i) {
  const int last = board.columns * board.rows - 1;
  switch (board.kind) {
    case BoardKind::kChessboard:
      // Squares of opposite corners have the same colour if there is an even number of points on two sides.
      if ((board.columns + board.rows) % 2 != 0) return std::nullopt;
      return last - i;
    case BoardKind::kCircles:
      return last - i;
    case BoardKind::kAsymmetricCircles:
      if (board.rows % 2 != 0) return std::nullopt;
      return last - i;
    case BoardKind::kCharuco:
    case BoardKind::kAprilTags:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace elbowroom::recon
