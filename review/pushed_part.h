// A rigid part that moves out of the hull's way.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/layout.h"
#include "core/rigid_transform.h"
#include "recon/visual_hull.h"
#include "review/surface_model.h"

namespace elbowroom::review {

// Where pushing has taken a part, and how the last step went.
struct PushState {
  Eigen::Vector3d moved_in_world = Eigen::Vector3d::Zero();  // mm, from where the layout has it
  // Of the last step: what it took to leave the hull, how far it went, whether another part was in the way.
  double wanted_mm = 0.0;
  double went_mm = 0.0;
  bool is_blocked = false;
};

struct StandingPart {
  const SurfaceModel* surface = nullptr;
  core::RigidTransform world_from_part;
};

// A pushed part keeps this far from the others.
inline constexpr double kPushGapMm = 0.05;

// The state `dt_s` later. A part in the hull moves by D_rec along V_rec: towards RP_obj as FindContacts finds
// it, or along the rule's axis, to the side where less brings every contact point out. Never faster than the
// rule allows, and never into another part: it goes as far as the gap to the others is wide, again and again,
// so nothing is passed however thin (pushed_part_test). Where V_rec isn't defined (RP_obj in the hull, a hull
// inside the part) it stays; a part that already touches another moves only away from it.
// Throws: PreconditionError for a dt_s that isn't within (0, 1] s. Thread: any.
[[nodiscard]] PushState StepPush(const core::PushRule& rule, PushState state, const StandingPart& part,
                                 std::span<const StandingPart> others, const recon::VisualHull& hull,
                                 double dt_s);

}  // namespace elbowroom::review
