// A rigid part that moves out of the hull's way.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/contact.h"
#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"
#include "review/surface_model.h"

namespace elbowroom::review {

// Where pushing has taken a part, and how the last step went. Lengths are the way of the part's fastest
// point.
struct PushState {
  core::RigidTransform rest_from_part;  // rest: the frame of the part where the layout has it
  double wanted_mm = 0.0;               // to leave the hull
  double went_mm = 0.0;
  bool is_blocked = false;  // another part was in the way
};

struct StandingPart {
  const SurfaceModel* surface = nullptr;
  core::RigidTransform world_from_part;
};

// A pushed part keeps this far from the others.
inline constexpr double kPushGapMm = 0.05;

// The state `dt_s` later. `contact`: FindContacts of the part, with its recovery, where `state` has it;
// `rest`: where the layout has it. Towards RP_obj the part moves as the paper's do, by CP_obj's D_rec; along
// a direction or slider, or about a hinge, by what brings every contact point out, in the sense that takes
// least. No point of it goes faster than the rule allows, nor into another part: it goes as far as the gap to
// the others is wide, again and again, so nothing is passed however thin (pushed_part_test). Without a way
// out (contact.recovery_status) it stays; a part that already touches another moves only away from it.
// Throws: PreconditionError for a dt_s that isn't within (0, 1] s. Thread: any.
[[nodiscard]] PushState StepPush(const core::Part& part, const core::PartContact& contact, PushState state,
                                 const StandingPart& rest, std::span<const StandingPart> others,
                                 const recon::VisualHull& hull, double dt_s);

}  // namespace elbowroom::review
