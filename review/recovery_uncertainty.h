// How far off each output of a recovery may be.
#pragma once

#include <optional>

#include "core/contact.h"
#include "recon/hull/visual_hull.h"
#include "review/recovery.h"

namespace elbowroom::review {

// A ready mask's boundary is somewhere between two pixels' centres, halfway in all it says.
inline constexpr double kReadyMaskPx = 0.5;

// Nothing where an output has no meaning or its bound none: V_rec that grazes the hull's surface.
struct RecoveryUncertainty {
  // No point of the part that is deeper than this in the hull is farther from RP_obj than CP_obj by more.
  double cp_obj_mm = 0.0;
  std::optional<double> v_rec_rad;
  std::optional<double> d_rec_mm;
  std::optional<double> cp_hull_mm;
  std::optional<double> n_hull_rad;
  // Surfaces of two cameras meet within a pixel of CP_hull: N_hull is one's, its uncertainty reaches the
  // other's.
  bool is_at_edge = false;
};

// Derived in docs/recovery.md, to first order in the silhouettes' error: from the contact search's
// resolution, silhouettes that are off by up to `silhouette_px` wherever it is worst (in finer pixels), the
// crossings' rounding. Held to shifted silhouettes by recovery_accuracy_test. Throws: PreconditionError
// for a contact without a recovery, a negative or infinite `silhouette_px`. Thread: any.
[[nodiscard]] RecoveryUncertainty UncertaintyOf(const recon::VisualHull& hull,
                                                const core::PartContact& contact, const RecoveryWay& way,
                                                double silhouette_px = kReadyMaskPx);

}  // namespace elbowroom::review
