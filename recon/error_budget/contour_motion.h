// How far a camera's contour moved from one of its pictures to its next.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "recon/contours/contour_map.h"

namespace elbowroom::recon {

// Of each vertex of both contours the distance to the other contour. It is that along the normal where the
// contour is smooth and moves little; no matching of points is needed. A part of a contour that appeared or
// vanished moved as far as to the nearest other part, or infinitely far. Frame: the camera's undistorted
// plane, px. Immutable. Thread: any.
class ContourMotion {
 public:
  ContourMotion() = default;  // nothing moved
  ContourMotion(const ContourMap& before, const ContourMap& now);

  [[nodiscard]] bool is_still() const { return points_.empty(); }

  // The most that a point moved, px, of those that are within `radius_px` of the position, or would be after
  // moving `share` of that once more. 0: none is.
  [[nodiscard]] double MostNear(const Eigen::Vector2d& position, double radius_px, double share) const;

 private:
  struct Point {
    Eigen::Vector2d position;
    double moved_px = 0.0;
  };
  void Add(const Contour& contour, const ContourMap& other);

  std::vector<Point> points_;
};

}  // namespace elbowroom::recon
