// What a board looks like, in millimetres: one source for its print and for pictures of it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "recon/boards/board.h"

namespace elbowroom::recon {

struct DrawnCircle {
  Eigen::Vector2d center_in_board;
  double radius_mm = 0.0;
};

// Shapes on a ground, in the board's frame, in mm. They are dark and the ground is light; an inverted board
// has light shapes on dark ground.
struct BoardDrawing {
  std::vector<Eigen::AlignedBox2d> rectangles;
  std::vector<DrawnCircle> circles;
  // The ground: the board and an empty margin around it, half a square or half a pitch wide.
  Eigen::AlignedBox2d ground;
  bool inverted = false;
};

// Throws: Error{kRange}, as BoardFinder.
[[nodiscard]] BoardDrawing DrawBoard(const Board& board);

}  // namespace elbowroom::recon
