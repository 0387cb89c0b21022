// How deep a part is in the hull: the shortest way out, between two bounds.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

// lower <= P <= upper. P is the length of the shortest translation after which part and hull have no point in
// common. The part is its surface and, if that is closed, what it encloses.
struct Penetration {
  double lower_mm = 0.0;
  double upper_mm = std::numeric_limits<double>::infinity();
  Eigen::Vector3d direction_in_world = Eigen::Vector3d::UnitZ();  // unit; the way of upper_mm
  Eigen::Vector3d deepest_in_world = Eigen::Vector3d::Zero();     // the point that shows lower
  bool leaves_workspace = false;  // as in EscapeDistance, for the way of upper_mm
  std::int64_t queries = 0;       // ball queries
  std::int64_t rays = 0;
  std::int64_t depths = 0;      // exact depths in the hull
  std::int64_t directions = 0;  // tried
};

// Lower: a ball in the hull and a ball in the part around the same point still meet while the part moves by
// less than the sum of their radii. Upper: the best of some fifty directions by FindEscapeDistance
// (docs/recovery.md). Both always hold; how close they are depends on the shapes. `contact`: that of the same
// part and hull. It takes tens of thousands of ball queries and about a thousand exact rays, so it is for
// single results, not for every frame. Throws: PreconditionError unless the contact's verdict is contact and
// has a point, and the tolerance is positive. Held to brute force by penetration_test. Thread: any.
[[nodiscard]] Penetration FindPenetration(const recon::VisualHull& hull, const core::TriangleTree& part,
                                          const core::RigidTransform& world_from_part,
                                          const core::PartContact& contact, double tolerance_mm = 0.5);

}  // namespace elbowroom::review
