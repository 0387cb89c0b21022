// One camera's pictures of a board that lies still, as one sighting.
#pragma once

#include <optional>
#include <vector>

#include "recon/boards/board.h"
#include "recon/boards/board_sighting.h"

namespace elbowroom::recon {

// The board rests as long as its points move together by no more than this, in the root mean square.
inline constexpr double kMostRestPx = 0.35;
// More pictures than these make the mean no more exact: a printed corner is off in all of them alike.
inline constexpr int kMostPicturesOfRest = 50;

class RestingBoard {
 public:
  RestingBoard(const Board& board, const BoardSighting& first);

  // Takes the picture if the board hasn't moved since the first one; it may be numbered from its other end.
  // Measured by the affine movement that fits the points best, so noise of single points doesn't count; a
  // picture whose points don't follow one movement isn't taken. False: it wasn't taken.
  bool Add(const BoardSighting& sighting);

  [[nodiscard]] int pictures() const { return pictures_; }

  // The mean of each point that half of the pictures show. How its standard deviation shrinks is measured: by
  // the share of the variance that changes from picture to picture. With v the stated variance, w that of the
  // changes and n pictures it is v - w + w / n, or v / n where w isn't clearly less than v.
  [[nodiscard]] BoardSighting Mean() const;

 private:
  struct PointSum {
    Eigen::Vector2d first = Eigen::Vector2d::Zero();
    Eigen::Vector2d change = Eigen::Vector2d::Zero();  // sums of what it is from `first`, and of its square
    double change2 = 0.0;
    double sigma_px = 0.0;
    int count = 0;
  };

  [[nodiscard]] bool Rests(const BoardSighting& sighting) const;
  void Take(const BoardSighting& sighting);
  [[nodiscard]] double ShareOfChange() const;

  std::optional<Board> turning_board_;  // of a board that looks the same after half a turn
  std::vector<PointSum> points_;        // by number
  int pictures_ = 0;
};

}  // namespace elbowroom::recon
