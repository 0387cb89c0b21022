// How far a whole part must be moved in one direction until it is free of the hull.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

struct EscapeOptions {
  double tolerance_mm = 0.5;  // wanted for upper - lower
  // The search ends once the way is sure to be this long; upper is then infinite.
  double give_up_mm = std::numeric_limits<double>::infinity();

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

// lower <= F <= upper. F is the least distance after which the part, moved in the direction, has no point in
// common with the hull. The part is its surface and, if that is closed, what it encloses.
struct EscapeDistance {
  double lower_mm = 0.0;
  double upper_mm = std::numeric_limits<double>::infinity();  // moved by this, the part is free
  bool leaves_workspace = false;  // it gets free where the cameras' sight ends, not where the hull does
  std::int64_t queries = 0;       // ball queries
  std::int64_t rays = 0;
};

// Upper: FindHullPartIntersection calls the part, moved by it, apart from the hull. Lower: points of the part
// move along rays; while at least one of them is in the hull, the part isn't free (docs/recovery.md). Usually
// upper - lower is half of the tolerance; it is more for a way along the hull's surface, where small pieces
// stay undecided. `witnesses`: points of the part at its present place, in world, whose rays are followed
// first; points that are found are added. Samples of penetration_test don't contradict the bounds. Throws:
// what Validate throws; PreconditionError for a direction that isn't unit. Thread: any.
[[nodiscard]] EscapeDistance FindEscapeDistance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                                const core::RigidTransform& world_from_part,
                                                const Eigen::Vector3d& direction_in_world,
                                                std::vector<Eigen::Vector3d>* witnesses,
                                                const EscapeOptions& options = {});

}  // namespace elbowroom::review
