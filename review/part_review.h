// Judges one part in one frame: contact, clearance, and the verdict.
#pragma once

#include <memory>
#include <optional>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/rigid_transform.h"
#include "recon/error_budget/hull_errors.h"
#include "recon/error_budget/skew_errors.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/clearance.h"
#include "review/contacts.h"

namespace elbowroom::review {

struct PartReviewOptions {
  ContactOptions contacts;
  double required_clearance_mm = 0.0;  // of the part to the hull; 0: only contact is judged
  double uncertainty_mm = 0.0;         // of the rig; `near` and `clear` allow for it
  // If set, what `near` and `clear` allow for is computed from these for each part, instead.
  std::shared_ptr<const recon::HullErrors> hull_errors;
  // Of this frame, if its cameras have stamps: what it gives is added to either of these.
  std::shared_ptr<const recon::SkewErrors> skew_errors;
  bool is_rig_refuted = false;  // by its gauge: then no part is `near` or `clear`, but `undecided`
  // The picture of a camera is missing in this frame, so that the hull is larger than with all cameras: then
  // only `clear` is sure, and all else is `undecided`.
  bool lacks_camera = false;
  double tolerance_mm = 1.0;  // wanted between a clearance's bounds

  // Throws: core::Error{kRange} naming the option.
  void Validate() const;
  // The search for a clearance ends once the part is sure to be this far away: required clearance, what is
  // allowed for, and tolerance together, so that a tracker sees the part leave.
  [[nodiscard]] double EnoughMm(double allowed_mm) const;
  [[nodiscard]] double EnoughMm() const { return EnoughMm(uncertainty_mm); }
  // What is allowed for: between a point of the hull and one of the part, and the worst at a point and for a
  // part in a box, in world. Nothing: `uncertainty_mm` is all.
  [[nodiscard]] std::optional<core::ErrorBudget> BudgetAt(const recon::VisualHull& hull,
                                                          const Eigen::Vector3d& x_of_hull,
                                                          const Eigen::Vector3d& x_of_part) const;
  [[nodiscard]] std::optional<core::ErrorBudget> WorstBudget(const recon::VisualHull& hull,
                                                             const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] std::optional<core::ErrorBudget> WorstBudget(const recon::VisualHull& hull,
                                                             const Eigen::AlignedBox3d& box_in_world) const;
  // Whether a part that is clear by its distance to the hull is so of what the hull may lack, because its
  // cameras don't look at one instant; `budget`: what its verdict allowed for.
  [[nodiscard]] bool StaysClear(const recon::VisualHull& hull, const core::TriangleTree& part,
                                const core::RigidTransform& world_from_part,
                                const std::optional<core::ErrorBudget>& budget) const;
  // Judge, with the required clearance and the rules for a refuted rig and for a missing camera.
  [[nodiscard]] core::Verdict VerdictOf(const Clearance& clearance, double allowed_mm) const;
  [[nodiscard]] core::Verdict VerdictOf(core::Verdict of_hull) const;

 private:
  [[nodiscard]] core::ErrorBudget GivenBudget() const;
};

struct ReviewedClearance {
  core::PartClearance clearance;
  core::Verdict verdict = core::Verdict::kClear;
};

// The clearance of a part that FindContacts finds in no contact: FindClearance as far as EnoughMm(), with
// Judge's verdict, and the budget. A function of these alone: nothing of other frames goes in. The required
// clearance is above 0. Thread: any.
[[nodiscard]] ReviewedClearance ReviewClearance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                                const core::RigidTransform& world_from_part,
                                                const PartReviewOptions& options,
                                                ReviewScratch* scratch = nullptr);

// FindContacts and, where a clearance is required, its bounds: 0 to the mesh's deviation, without a search,
// where there is contact; else ReviewClearance. So a part that meets the hull in less than the contacts'
// resolution is in `contact` too, but without points. A function of hull, part, pose and options: the same in
// a trial, a replay and a spacing study. With `hull_errors` or `skew_errors`, the budget of the answer is
// that of its witness points; without witnesses, the worst in the part's box. With the latter, a part is
// `clear` only if the hull's contours, moved on by 2 sigma, leave it so. `inside`, `scratch`: as in
// FindContacts. Held to FindContacts and FindClearance by part_review_test. Thread: any.
[[nodiscard]] core::PartContact ReviewPart(const recon::VisualHull& hull, const core::TriangleTree& part,
                                           const core::RigidTransform& world_from_part,
                                           core::PartIndex part_index, const PartReviewOptions& options,
                                           InsideCells* inside = nullptr, ReviewScratch* scratch = nullptr);

}  // namespace elbowroom::review
