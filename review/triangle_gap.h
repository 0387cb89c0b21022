// The distance of two triangles, and where it is attained.
#pragma once

#include <Eigen/Core>
#include <array>

namespace elbowroom::review {

using Triangle = std::array<Eigen::Vector3d, 3>;

// The least distance between two surfaces and a point of each that shows it; a common point where they meet.
struct SurfaceGap {
  double distance_mm = 0.0;
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
};

// Both triangles and the points are in one frame. A triangle without area counts as the segment or point that
// it is. Exact but for rounding, some 1e-15 of the coordinates' size: held to long double, parallel edges and
// needles included, by tests/review/triangle_gap_test.cc. Thread: any.
[[nodiscard]] SurfaceGap GapBetween(const Triangle& a, const Triangle& b);

}  // namespace elbowroom::review
