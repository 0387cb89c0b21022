// How far a part is from the hull, between two certain bounds.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/bvh.h"
#include "core/clearance.h"
#include "core/contact.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/review_scratch.h"

namespace elbowroom::review {

struct ClearanceOptions {
  double tolerance_mm = 1.0;  // wanted for upper - lower
  // The search ends once the part is sure to be this far away: lower is then at least this, and upper may be
  // infinite.
  double enough_mm = std::numeric_limits<double>::infinity();
  std::int64_t max_queries = 1'000'000;  // of the hull; then the search ends with the bounds that it has

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
};

struct Clearance {
  // Both infinite when the hull has no points; when hull and part meet, from 0 to the mesh's deviation.
  core::ClearanceInterval interval;
  bool meets = false;           // the hull and the part's mesh have a point in common
  bool has_witnesses = false;   // the interval's witness points are set; they show its upper bound
  std::int64_t queries = 0;     // of the hull
  std::int64_t distances = 0;   // from a point to the part
  std::int64_t cells_left = 0;  // of space, that were waiting when the search ended
  std::int64_t cut_cells = 0;   // of space, shortened or dropped as far enough from the part
};

// The last frame's witness points: where the next frame's search begins.
struct ClearanceHint {
  Eigen::Vector3d witness_part_in_part = Eigen::Vector3d::Zero();
  Eigen::Vector3d witness_hull_in_world = Eigen::Vector3d::Zero();
};

// Distance from the part's surface to the hull's nearest point, by branch and bound over cells of space
// (docs/clearance.md). lower <= distance <= upper always holds. For the mesh, upper - lower <= tolerance,
// unless enough_mm was reached, the queries ran out, or the hull is thinner there than the smallest cells can
// tell. The returned bounds are those of the surface that the mesh approximates: wider by the mesh's
// deviation on either side. A hull whose nearest point found is inside a closed part meets it. The hint
// changes the work and where within the tolerance the bounds fall, but they stay true. Held to an oracle by
// clearance_test. `scratch`: memory that is kept from search to search. Thread: any.
[[nodiscard]] Clearance FindClearance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                      const core::RigidTransform& world_from_part,
                                      const ClearanceOptions& options = {},
                                      const std::optional<ClearanceHint>& hint = {},
                                      ReviewScratch* scratch = nullptr);

// The verdict for a required clearance. `contact` where hull and mesh meet; otherwise `near` and `clear` only
// where an error of `uncertainty_mm` (the rig's) in the bounds can't change them, else `undecided`.
[[nodiscard]] core::Verdict Judge(const Clearance& clearance, double required_mm, double uncertainty_mm);

}  // namespace elbowroom::review
