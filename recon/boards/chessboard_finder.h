// Chessboards in a picture.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"

namespace elbowroom::recon {

// `grey`: light squares are light. At least four fifths of the corners must be seen, of each outer line at
// least half; otherwise the numbers aren't certain. If the board has an even number of squares on one side
// and an odd one on the other, the first point is the one whose outermost square is black.
[[nodiscard]] std::optional<BoardSighting> FindChessboard(const cv::Mat& grey, const Board& board);

}  // namespace elbowroom::recon
