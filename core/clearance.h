// A distance that is known to lie between two bounds, with the points that show it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/error_budget.h"

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
  // What the verdict allows for. Nothing: what the trial says for all parts.
  std::optional<ErrorBudget> budget = {};

  // 95 %: what the verdict allows for, where `given_mm` is what the trial says.
  [[nodiscard]] double AllowedMm(double given_mm) const { return budget ? budget->ExpandedMm() : given_mm; }
};

}  // namespace elbowroom::core
