// A distance that is known to lie between two bounds, with the points that show it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace elbowroom::core {

struct ClearanceInterval {
  double lower_mm = 0.0;                                      // never above the true distance
  double upper_mm = std::numeric_limits<double>::infinity();  // never below it
  Eigen::Vector3d witness_part_in_world_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d witness_hull_in_world_mm = Eigen::Vector3d::Zero();
};

// The clearance of one part to the hull in one frame.
struct PartClearance {
  // From 0 to the mesh's deviation where part and hull meet. Both bounds are infinite if the hull has no
  // points.
  ClearanceInterval interval;
  bool has_witnesses = false;  // the interval's witness points are set; they show its upper bound
  std::int64_t queries = 0;    // asked of the hull
};

}  // namespace elbowroom::core
