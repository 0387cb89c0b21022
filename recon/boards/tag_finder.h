// Grids of AprilTags, or of other markers, in a picture.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"
#include "recon/boards/marker_dictionary.h"

namespace elbowroom::recon {

// `grey`: tags are dark on light ground. Two tags must agree with each other, unless the board has only one.
[[nodiscard]] std::optional<BoardSighting> FindTags(const cv::Mat& grey, const Board& board,
                                                    const MarkerDictionary& dictionary);

}  // namespace elbowroom::recon
