// A board on a page to print, true to scale.
#pragma once

#include <Eigen/Core>
#include <string>

#include "recon/boards/board.h"
#include "recon/boards/board_drawing.h"

namespace elbowroom::recon {

struct BoardPage {
  std::string paper;  // "A4", "A3 landscape", or "custom" where no standard paper is large enough
  double width_mm = 0.0;
  double height_mm = 0.0;
  // The page's place of the board's origin, from its lower left corner; x to the right, y up.
  Eigen::Vector2d origin_on_page_mm;
};

// The smallest of A4 to A0 that has the drawing, its rulers and its lines of text; otherwise a page of its
// own.
[[nodiscard]] BoardPage PageFor(const BoardDrawing& drawing);

// The board as CALIB.toml has it, in one line: board = { type = "chessboard", ... }.
[[nodiscard]] std::string BoardAsToml(const Board& board);

// The bytes of a PDF file of one page: the board, a ruler of 100 mm on both axes that shows whether the
// printer kept the scale, and the board's values. board_page_test finds the board in the printed page.
// Throws: as DrawBoard; Error{kFile} if the PDF can't be made.
[[nodiscard]] std::string BoardAsPdf(const Board& board, const BoardPage& page);

}  // namespace elbowroom::recon
