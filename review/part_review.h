// All that is asked of one part in one frame: contact, how near, and the verdict.
#pragma once

#include <optional>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull.h"
#include "review/clearance.h"
#include "review/contacts.h"

namespace elbowroom::review {

struct PartReviewOptions {
  ContactOptions contacts;
  double required_clearance_mm = 0.0;  // of the part to the hull; 0: only contact is judged
  double uncertainty_mm = 0.0;         // of the rig: what `near` and `clear` allow for
  double tolerance_mm = 1.0;           // between a clearance's bounds

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
  // A part that is sure to be so far away isn't looked at any closer: what is required, what is allowed for,
  // and the bounds' width, so that a tracker sees it leave.
  [[nodiscard]] double EnoughMm() const;
};

// FindContacts and, where a clearance is required, bounds of it: 0 to the mesh's deviation without a search
// where there is contact; else FindClearance as far as EnoughMm(). The verdict is Judge's.
// HullPartIntersection in less than the contacts' resolution is `contact` too, without points. The hint
// changes the work, and where in the tolerance the bounds fall; `inside`: as FindContacts. Held to
// FindContacts and FindClearance by part_review_test. Thread: any.
[[nodiscard]] core::PartContact ReviewPart(const recon::VisualHull& hull, const core::TriangleTree& part,
                                           const core::RigidTransform& world_from_part,
                                           core::PartIndex part_index, const PartReviewOptions& options,
                                           const std::optional<ClearanceHint>& hint = {},
                                           InsideCells* inside = nullptr);

// What a part's last answer, at its pose then, tells the next search; nothing without witnesses.
[[nodiscard]] std::optional<ClearanceHint> HintFrom(const core::PartContact& last,
                                                    const core::RigidTransform& world_from_part);

}  // namespace elbowroom::review
