// How far a whole part must be moved in one direction until the hull lets it go.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/bvh.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

struct EscapeOptions {
  double tolerance_mm = 0.5;  // how far past what is known to be in contact a free place is looked for
  // A way that is sure to be this long isn't followed any farther: then upper is infinite.
  double give_up_mm = std::numeric_limits<double>::infinity();

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

// lower <= F <= upper, F the least distance by which the part, moved in the direction, has no point in common
// with the hull: its surface, and if it is closed what that encloses.
struct EscapeDistance {
  double lower_mm = 0.0;
  double upper_mm = std::numeric_limits<double>::infinity();  // moved so far, it is free
  bool leaves_workspace = false;  // what lets it go is the end of what the cameras see, not of the hull
  std::int64_t queries = 0;       // ball queries
  std::int64_t rays = 0;
};

// Upper: a place that FindHullPartIntersection calls apart. Lower: points of the part go along rays; while
// one or another of them is in the hull, so is the part (docs/recovery.md). Usually upper - lower is half of
// the tolerance; a way along the hull's surface, where nothing small is ever certain, leaves more.
// `witnesses`: points of the part where it stands, in world, to be asked first; those that were found are
// added. `direction` is unit. Never contradicted by penetration_test's samples. Throws: what Validate throws;
// PreconditionError for a direction that isn't unit. Thread: any.
[[nodiscard]] EscapeDistance FindEscapeDistance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                                const core::RigidTransform& world_from_part,
                                                const Eigen::Vector3d& direction_in_world,
                                                std::vector<Eigen::Vector3d>* witnesses,
                                                const EscapeOptions& options = {});

}  // namespace elbowroom::review
