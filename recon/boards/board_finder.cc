#include "recon/boards/board_finder.h"

#include <fmt/format.h>

#include <algorithm>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "recon/boards/charuco_finder.h"
#include "recon/boards/chessboard_finder.h"
#include "recon/boards/circle_grid_finder.h"
#include "recon/boards/marker_dictionary.h"
#include "recon/boards/tag_finder.h"

namespace elbowroom::recon {

struct BoardFinder::Parts {
  Board board;
  std::optional<MarkerDictionary> dictionary;
};

BoardFinder::BoardFinder(const Board& board) {
  board.Validate();
  Parts parts{board, std::nullopt};
  if (board.has_markers()) {
    parts.dictionary.emplace(board.dictionary);
    const std::size_t needed = MarkersOf(board).size();
    const int there = parts.dictionary->marker_count();
    if (needed > static_cast<std::size_t>(there))
      throw core::Error(
          core::ErrorKind::kRange,
          fmt::format("the board: it has {} markers, and {} has only {}; take a larger dictionary", needed,
                      board.dictionary, there));
  }
  parts_ = std::make_unique<const Parts>(std::move(parts));
}
BoardFinder::~BoardFinder() = default;
BoardFinder::BoardFinder(BoardFinder&&) noexcept = default;
BoardFinder& BoardFinder::operator=(BoardFinder&&) noexcept = default;

const Board& BoardFinder::board() const { return parts_->board; }

std::optional<BoardSighting> BoardFinder::Find(const cv::Mat& grey_or_bgr) const {
  core::Require(grey_or_bgr.depth() == CV_8U && (grey_or_bgr.channels() == 1 || grey_or_bgr.channels() == 3),
                "the picture has one or three channels of 8 bits");
  constexpr int kSmallestPx = 16;
  if (std::min(grey_or_bgr.cols, grey_or_bgr.rows) < kSmallestPx) return std::nullopt;
  const Board& board = parts_->board;
  cv::Mat grey = grey_or_bgr;
  if (grey.channels() == 3) cv::cvtColor(grey_or_bgr, grey, cv::COLOR_BGR2GRAY);
  if (board.inverted) {
    cv::Mat inverted;
    cv::bitwise_not(grey, inverted);
    grey = inverted;
  }
  switch (board.kind) {
    case BoardKind::kChessboard:
      return FindChessboard(grey, board);
    case BoardKind::kCharuco:
      return FindCharuco(grey, board, *parts_->dictionary);
    case BoardKind::kAprilTags:
      return FindTags(grey, board, *parts_->dictionary);
    case BoardKind::kCircles:
    case BoardKind::kAsymmetricCircles:
      return FindCircleGrid(grey, board);
  }
  return std::nullopt;
}

}  // namespace elbowroom::recon
