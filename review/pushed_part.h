// A rigid part that the hull pushes along.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/contact.h"
#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/surface_model.h"

namespace elbowroom::review {

// Where pushing has moved a part, and the last step. Lengths are measured along the way of the part's fastest
// point.
struct PushState {
  core::RigidTransform rest_from_part;  // rest: the part's frame at its pose in the layout
  double wanted_mm = 0.0;               // the way that leaves the hull
  double went_mm = 0.0;
  bool is_blocked = false;  // another part shortened the last step
};

struct StandingPart {
  const SurfaceModel* surface = nullptr;
  core::RigidTransform world_from_part;
};

// A pushed part keeps this far from the others.
inline constexpr double kPushGapMm = 0.05;

// The state `dt_s` later. `contact`: FindContacts of the part, with its recovery, at the pose of `state`;
// `rest`: the part at its pose in the layout. Towards RP_obj the part moves by CP_obj's D_rec, as in the
// paper. Along a direction or slider, or about a hinge, it moves until every contact point is out, in the
// sense with the shorter way. No point of it is faster than the rule allows. It moves in steps no longer than
// the gap to the other parts, so it passes through none, however thin (pushed_part_test). Without a way out
// (contact.recovery_status) it stays. A part that already touches another moves only away from it.
// Throws: PreconditionError for a dt_s that isn't within (0, 1] s. Thread: any.
[[nodiscard]] PushState StepPush(const core::Part& part, const core::PartContact& contact, PushState state,
                                 const StandingPart& rest, std::span<const StandingPart> others,
                                 const recon::VisualHull& hull, double dt_s);

}  // namespace elbowroom::review
