// How deep a part is in the hull: the shortest way out, between two bounds.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

// lower <= P <= upper, P the length of the shortest translation after which part and hull have no point in
// common; the part is its surface, and if it is closed what that encloses.
struct Penetration {
  double lower_mm = 0.0;
  double upper_mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d direction_in_world = Eigen::Vector3d::UnitZ();  // unit; upper_mm that way, the part is free
  Eigen::Vector3d deepest_in_world = Eigen::Vector3d::Zero();     // the point that shows lower
  bool leaves_workspace = false;  // as EscapeDistance's, of the way that upper is
  std::int64_t queries = 0;       // ball queries
  std::int64_t rays = 0;
  std::int64_t depths = 0;      // exact depths in the hull
  std::int64_t directions = 0;  // tried
};

// Lower: a ball in the hull and one in the part about the same point still meet while the part moves less
// than both radii together; upper: the best of some fifty directions by FindEscapeDistance
// (docs/recovery.md). Both always hold; how near they come to each other depends on the shapes. `contact`: of
// the same part and hull. Its own work is some ten thousand ball queries and hundreds of exact rays: for a
// result that is looked at, not for every frame. Throws: PreconditionError unless the contact's verdict is
// contact and the tolerance positive. Held to brute force by penetration_test. Thread: any.
[[nodiscard]] Penetration FindPenetration(const recon::VisualHull& hull, const core::TriangleTree& part,
                                          const core::RigidTransform& world_from_part,
                                          const core::PartContact& contact, double tolerance_mm = 0.5);

}  // namespace elbowroom::review
