// Finds a calibration board in a picture, and its points to a small part of a pixel.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"

namespace elbowroom::recon {

// Made once for a board; then any number of threads may look for it, each in a picture of its own.
class BoardFinder {
 public:
  // Throws: Error{kRange}: Board::Validate; no such dictionary, or fewer markers in it than on the board.
  explicit BoardFinder(const Board& board);
  ~BoardFinder();
  BoardFinder(BoardFinder&&) noexcept;
  BoardFinder& operator=(BoardFinder&&) noexcept;

  [[nodiscard]] const Board& board() const;

  // `grey_or_bgr`: 8 bits a channel, one or three channels. Boards with markers may be partly out of the
  // picture; of others at least four fifths must be seen, and half of each outer line. The numbers are right
  // (up to half a turn, where a board looks the same then), or there is no sighting: points agree with one
  // plane behind a radial lens, and squares have their colours. How exact: docs/calibration.md, measured by
  // board_finder_test and real_boards_test. Thread: any.
  [[nodiscard]] std::optional<BoardSighting> Find(const cv::Mat& grey_or_bgr) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace elbowroom::recon
