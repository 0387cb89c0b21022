// How far off each output of a recovery may be.
#pragma once

#include <optional>

#include "core/contact.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/recovery.h"

namespace elbowroom::review {

// How far the boundary of a ready mask may be off: it lies between two pixel centres and is taken to be
// halfway.
inline constexpr double kReadyMaskPx = 0.5;

// An output is nothing where it has no meaning, or has no bound because V_rec grazes the hull's surface.
struct RecoveryUncertainty {
  // A point of the part that is deeper than this in the hull is at most this much farther from RP_obj than
  // CP_obj.
  double cp_obj_mm = 0.0;
  std::optional<double> v_rec_rad;
  std::optional<double> d_rec_mm;
  std::optional<double> cp_hull_mm;
  std::optional<double> n_hull_rad;
  // Another camera's surface meets the hull within a pixel (and the silhouettes' error) of CP_hull. N_hull is
  // the normal of one of them; its uncertainty includes the others'.
  bool is_at_edge = false;
};

// Derived in docs/recovery.md, to first order in the silhouettes' error. The sources of error are the contact
// search's resolution, silhouettes whose boundaries are off by up to `silhouette_px` in any way, and the
// rounding of crossings. Held to shifted silhouettes by recovery_accuracy_test. Throws: PreconditionError for
// a contact without a recovery, or a `silhouette_px` that is negative or not finite. Thread: any.
[[nodiscard]] RecoveryUncertainty UncertaintyOf(const recon::VisualHull& hull,
                                                const core::PartContact& contact, const RecoveryWay& way,
                                                double silhouette_px = kReadyMaskPx);

}  // namespace elbowroom::review
