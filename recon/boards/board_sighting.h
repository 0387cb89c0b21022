// Where a board's points are in one picture.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace elbowroom::recon {

struct SightedPoint {
  int point = 0;          // its place in PointsOf(board)
  Eigen::Vector2d pixel;  // pixel centres at whole numbers
  double sigma_px = 0.1;  // standard deviation of each coordinate, as far as the picture tells

  [[nodiscard]] bool operator==(const SightedPoint&) const = default;
};

// At least four points that aren't on one line, ordered by their numbers, each at most once. A board that
// looks the same after half a turn may be numbered from either end.
struct BoardSighting {
  std::vector<SightedPoint> points;

  [[nodiscard]] bool operator==(const BoardSighting&) const = default;
};

}  // namespace elbowroom::recon
