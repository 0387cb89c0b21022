// ChArUco boards in a picture: chessboards with markers in their light squares.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"
#include "recon/boards/marker_dictionary.h"

namespace elbowroom::recon {

// `grey`: light squares are light. Any part of the board with a marker will do, if four corners are seen that
// aren't on a line. Markers say where the corners around them are; each corner is found by its own levels,
// and so are their neighbours that no marker tells of.
[[nodiscard]] std::optional<BoardSighting> FindCharuco(const cv::Mat& grey, const Board& board,
                                                       const MarkerDictionary& dictionary);

}  // namespace elbowroom::recon
