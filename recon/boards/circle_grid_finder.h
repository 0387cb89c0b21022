// Grids of circles in a picture.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"

namespace elbowroom::recon {

// `grey`: circles are dark on light ground, all of one size. At least four fifths must be seen, and of each
// outer line half. Points are where the circles' centres fall, not the centres of the ellipses: the two
// differ in perspective.
[[nodiscard]] std::optional<BoardSighting> FindCircleGrid(const cv::Mat& grey, const Board& board);

}  // namespace elbowroom::recon
