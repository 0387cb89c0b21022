// What a calibration board is: its kind, its measures and where its points are.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::recon {

enum class BoardKind { kChessboard, kCharuco, kAprilTags, kCircles, kAsymmetricCircles };

// As CALIB.toml writes it: chessboard, charuco, apriltag, circles, circles_asymmetric.
[[nodiscard]] std::optional<BoardKind> ParseBoardKind(std::string_view text);
[[nodiscard]] std::string_view ToString(BoardKind kind);

// Where a ChArUco board's first marker stands. kCurrent: a black square is in the board's first corner; the
// markers are on the white squares. kLegacy (OpenCV before 4.6): as there, where the number of rows is odd;
// where it is even, a white square is in the first corner.
enum class CharucoLayout { kCurrent, kLegacy };

// A chessboard's first square, outside of its first inner corner, is black.
//
// Frame `board`: the printed side looks along +z; x runs along the columns, and the rows run towards -y, as
// in print. The origin is the board's first point (chessboard, circles), or the first corner of its outermost
// square or tag (ChArUco, AprilTags).
struct Board {
  BoardKind kind = BoardKind::kChessboard;
  // Chessboard: inner corners. Circles: centres. ChArUco: squares. AprilTags: tags.
  int columns = 0;
  int rows = 0;
  double square_mm = 0.0;  // AprilTags: pitch of the tags; circles: pitch of the centres
  double marker_mm = 0.0;  // side of a marker; ChArUco and AprilTags only
  std::string dictionary;  // as OpenCV names it: "DICT_6X6_250", "DICT_APRILTAG_36h11"; the same two only
  CharucoLayout layout = CharucoLayout::kCurrent;
  bool inverted = false;  // white and black are exchanged

  [[nodiscard]] bool has_markers() const {
    return kind == BoardKind::kCharuco || kind == BoardKind::kAprilTags;
  }
  // Throws: Error{kRange} saying which value must be what.
  void Validate() const;
};

// In the board's frame, in mm, row by row; the place in the list is the point's number. ChArUco: the inner
// corners of the squares. AprilTags: four corners of each tag, as in BoardMarker.
[[nodiscard]] std::vector<Eigen::Vector3d> PointsOf(const Board& board);

struct BoardMarker {
  int id = 0;
  // In the board's frame, in mm: first column's and first row's corner, then clockwise in print.
  std::array<Eigen::Vector2d, 4> corners_in_board;
};
// Empty for boards without markers.
[[nodiscard]] std::vector<BoardMarker> MarkersOf(const Board& board);

// The number of the point that takes the place of point `i` when the board is turned by half a turn, for
// boards that look the same then. Nothing for boards whose points can be told apart.
[[nodiscard]] std::optional<int> PointAfterHalfTurn(const Board& board, int i);

}  // namespace elbowroom::recon
