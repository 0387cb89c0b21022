// The area that directed segments enclose, as triangles.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace elbowroom::control {

struct DirectedSegment {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

using FlatTriangle = std::array<Eigen::Vector2d, 3>;  // counter-clockwise

// The points around which the segments wind at least once counter-clockwise: their left sides, where the
// segments are closed loops in any order. Holes run clockwise. The plane is divided into strips between the
// segments' ends; in a strip no segment begins or ends, so it falls into trapezoids. Gaps between segments
// show as missing or too long strips. Segments may cross only at their ends, but for rounding.
[[nodiscard]] std::vector<FlatTriangle> FillOutline(std::span<const DirectedSegment> segments);

}  // namespace elbowroom::control
