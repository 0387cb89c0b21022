// How far a part is from the hull, between two bounds that are never wrong.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/bvh.h"
#include "core/clearance.h"
#include "core/contact.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

struct ClearanceOptions {
  double tolerance_mm = 1.0;  // of upper - lower
  // A part that is sure to be this far away isn't looked at any closer: lower is at least this, upper may
  // then be infinite.
  double enough_mm = std::numeric_limits<double>::infinity();
  std::int64_t max_queries = 1'000'000;  // of the hull; then the bounds as they are

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

struct Clearance {
  // Both infinite when the hull has no points; when hull and part meet, from 0 to the mesh's deviation.
  core::ClearanceInterval interval;
  bool meets = false;           // the hull and the part's mesh
  bool has_witnesses = false;   // interval's: of the upper bound
  std::int64_t queries = 0;     // of the hull
  std::int64_t distances = 0;   // of a point to the part
  std::int64_t cells_left = 0;  // of space, that were never looked into
  std::int64_t cut_cells = 0;   // of which a part was left out as it is far enough from the part
};

// What the last frame's answer is good for in the next one: where to look first.
struct ClearanceHint {
  Eigen::Vector3d witness_part_in_part = Eigen::Vector3d::Zero();
  Eigen::Vector3d witness_hull_in_world = Eigen::Vector3d::Zero();
};

// Distance from the part's surface to the hull's nearest point, by branch and bound over cells of space
// (docs/clearance.md): lower <= distance <= upper always, upper - lower <= tolerance unless the queries ran
// out or the hull is thinner there than the smallest cells can tell. Both are of the surface that the mesh
// stands for, and so further apart by the mesh's deviation on either side. A hull that stands inside a closed
// part meets it. The hint changes the work, not the bounds' truth. Held to an oracle by clearance_test.
// Thread: any.
[[nodiscard]] Clearance FindClearance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                      const core::RigidTransform& world_from_part,
                                      const ClearanceOptions& options = {},
                                      const std::optional<ClearanceHint>& hint = {});

// The verdict of a required clearance, the bounds being good to `uncertainty_mm` (the rig's): `near` and
// `clear` only where that can't change it. Where hull and mesh meet: `contact`.
[[nodiscard]] core::Verdict Judge(const Clearance& clearance, double required_mm, double uncertainty_mm);

}  // namespace elbowroom::review
