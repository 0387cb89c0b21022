// How far a contact point must move, along the way that its part allows, to leave the hull.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/recovery_rule.h"
#include "core/rigid_transform.h"
#include "recon/hull/crossing_scratch.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::review {

// core::RecoveryRule at the part's present pose. Frame: world.
struct RecoveryWay {
  core::RecoveryKind kind = core::RecoveryKind::kReference;
  Eigen::Vector3d rp_obj = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();   // unit; 0 for kReference
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // on the hinge's axis
  int sense = 0;  // for a slider or hinge: 1 or -1: only that sense; 0: the sense with the shorter way
};

// The part must have triangles. Throws: PreconditionError for a rule that can't be used.
[[nodiscard]] RecoveryWay WayOf(const core::RecoveryRule& rule, const core::TriangleTree& part,
                                const core::RigidTransform& world_from_part);

struct RecoveryAnswer {
  core::RecoveryStatus status = core::RecoveryStatus::kNoContact;
  std::optional<core::Recovery> recovery;
};

// CP_hull, D_rec and N_hull of a point of the hull (docs/recovery.md). Towards an RP_obj that is outside of
// the hull, CP_hull is the paper's: the first hull point from RP_obj. Any other way ends where the stretch of
// hull that holds CP_obj ends. Exact but for rounding, some 1e-6 px. A way that only a face of the workspace
// or the border of a picture ends has the status `no exit`. Held to a marching oracle and to closed forms by
// recovery_test. Thread: any.
[[nodiscard]] RecoveryAnswer Recover(const recon::VisualHull& hull, const Eigen::Vector3d& cp_obj_in_world,
                                     const RecoveryWay& way);
[[nodiscard]] RecoveryAnswer Recover(const recon::VisualHull& hull, const Eigen::Vector3d& cp_obj_in_world,
                                     const RecoveryWay& way, recon::CrossingScratch* scratch);

}  // namespace elbowroom::review
