#include "review/part_review.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace elbowroom::review {
namespace {

// The clearance of a part that meets the hull: 0 to the mesh's deviation. Its witness is the deepest point,
// or the point of the hull inside the part.
core::PartClearance ClearanceInContact(const core::PartContact& contact, double deviation_mm) {
  core::PartClearance clearance;
  clearance.interval.upper_mm = deviation_mm;
  const auto at =
      contact.deepest ? std::optional(contact.deepest->position_in_world_mm) : contact.contained_in_world_mm;
  clearance.has_witnesses = at.has_value();
  if (at) clearance.interval.witness_part_in_world_mm = clearance.interval.witness_hull_in_world_mm = *at;
  return clearance;
}

}  // namespace

void PartReviewOptions::Validate() const {
  contacts.Validate();
  const auto require = [](double length_mm, const char* what) {
    if (length_mm >= 0.0 && std::isfinite(length_mm)) return;
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("{} must be 0 mm or more, not {}", what, length_mm));
  };
  require(required_clearance_mm, "the required clearance");
  require(uncertainty_mm, "the uncertainty");
  ClearanceOptions clearance;
  clearance.tolerance_mm = tolerance_mm;
  clearance.Validate();
}

double PartReviewOptions::EnoughMm(double allowed_mm) const {
  return required_clearance_mm + allowed_mm + tolerance_mm;
}

std::optional<core::ErrorBudget> PartReviewOptions::BudgetAt(const recon::VisualHull& hull,
                                                             const Eigen::Vector3d& x_of_hull,
                                                             const Eigen::Vector3d& x_of_part) const {
  if (!hull_errors && !skew_errors) return std::nullopt;
  core::ErrorBudget budget = hull_errors ? hull_errors->At(hull, x_of_hull, x_of_part) : GivenBudget();
  if (skew_errors) budget.skew_mm = skew_errors->AtMm(hull, x_of_hull, x_of_part);
  return budget;
}

std::optional<core::ErrorBudget> PartReviewOptions::WorstBudget(const recon::VisualHull& hull,
                                                                const Eigen::Vector3d& x_in_world) const {
  if (!hull_errors && !skew_errors) return std::nullopt;
  core::ErrorBudget budget = hull_errors ? hull_errors->WorstAt(x_in_world) : GivenBudget();
  if (skew_errors) budget.skew_mm = skew_errors->WorstInMm(hull, {x_in_world, required_clearance_mm});
  return budget;
}

std::optional<core::ErrorBudget> PartReviewOptions::WorstBudget(
    const recon::VisualHull& hull, const Eigen::AlignedBox3d& box_in_world) const {
  if (!hull_errors && !skew_errors) return std::nullopt;
  core::ErrorBudget budget = hull_errors ? hull_errors->WorstIn(box_in_world) : GivenBudget();
  if (skew_errors && !box_in_world.isEmpty())
    budget.skew_mm = skew_errors->WorstInMm(
        hull, {box_in_world.center(), 0.5 * box_in_world.diagonal().norm() + required_clearance_mm});
  return budget;
}

bool PartReviewOptions::StaysClear(const recon::VisualHull& hull, const core::TriangleTree& part,
                                   const core::RigidTransform& world_from_part,
                                   const std::optional<core::ErrorBudget>& budget) const {
  if (!skew_errors || skew_errors->is_still()) return true;
  core::ErrorBudget rest = budget ? *budget : GivenBudget();
  rest.skew_mm = 0.0;  // it is in the contours' motion
  const double distance_mm = required_clearance_mm + rest.ExpandedMm() + part.mesh().deviation_mm;
  return skew_errors->StaysFarther(hull, part, world_from_part, distance_mm, tolerance_mm);
}

core::ErrorBudget PartReviewOptions::GivenBudget() const {
  core::ErrorBudget budget;
  budget.given_mm = uncertainty_mm / core::kCoverageFactor;
  return budget;
}

core::Verdict PartReviewOptions::VerdictOf(const Clearance& clearance, double allowed_mm) const {
  return VerdictOf(Judge(clearance, required_clearance_mm, allowed_mm));
}

core::Verdict PartReviewOptions::VerdictOf(core::Verdict of_hull) const {
  if (is_rig_refuted && of_hull != core::Verdict::kContact) return core::Verdict::kUndecided;
  if (lacks_camera && of_hull != core::Verdict::kClear) return core::Verdict::kUndecided;
  return of_hull;
}

// Searches as far as the worst of the rig's errors near the part makes necessary. Where the errors at the
// witness points turn out to be larger, as at a thin edge of the hull, and the search ended too early for a
// verdict, it is made again, farther.
ReviewedClearance ReviewClearance(const recon::VisualHull& hull, const core::TriangleTree& part,
                                  const core::RigidTransform& world_from_part,
                                  const PartReviewOptions& options, ReviewScratch* scratch) {
  std::optional<core::ErrorBudget> budget = options.WorstBudget(hull, core::BoxAround(part, world_from_part));
  double allowed_mm = budget ? budget->ExpandedMm() : options.uncertainty_mm;
  ClearanceOptions clearance_options;
  clearance_options.tolerance_mm = options.tolerance_mm;
  std::int64_t queries = 0;
  for (;;) {
    clearance_options.enough_mm = options.EnoughMm(allowed_mm);
    const Clearance found = FindClearance(hull, part, world_from_part, clearance_options, {}, scratch);
    const core::ClearanceInterval& interval = found.interval;
    queries += found.queries;
    if (budget && found.has_witnesses && !found.meets)
      budget = options.BudgetAt(hull, interval.witness_hull_in_world_mm, interval.witness_part_in_world_mm);
    const double needed_mm = budget ? budget->ExpandedMm() : allowed_mm;
    const bool has_ended_early = interval.lower_mm >= clearance_options.enough_mm;
    if (has_ended_early && interval.lower_mm < options.required_clearance_mm + needed_mm) {
      allowed_mm = needed_mm;
      continue;
    }
    ReviewedClearance reviewed{{interval, found.has_witnesses, queries, budget},
                               options.VerdictOf(found, needed_mm)};
    if (reviewed.verdict == core::Verdict::kClear && !options.StaysClear(hull, part, world_from_part, budget))
      reviewed.verdict = core::Verdict::kUndecided;
    return reviewed;
  }
}

core::PartContact ReviewPart(const recon::VisualHull& hull, const core::TriangleTree& part,
                             const core::RigidTransform& world_from_part, core::PartIndex part_index,
                             const PartReviewOptions& options, InsideCells* inside, ReviewScratch* scratch) {
  core::PartContact contact =
      FindContacts(hull, part, world_from_part, part_index, options.contacts, inside, scratch);
  const bool is_touched = contact.verdict == core::Verdict::kContact;
  contact.verdict = options.VerdictOf(contact.verdict);
  if (!(options.required_clearance_mm > 0.0)) return contact;
  if (is_touched) {
    contact.clearance = ClearanceInContact(contact, part.mesh().deviation_mm);
    const Eigen::Vector3d& at = contact.clearance->interval.witness_hull_in_world_mm;
    if (contact.clearance->has_witnesses) contact.clearance->budget = options.WorstBudget(hull, at);
    return contact;
  }
  const ReviewedClearance reviewed = ReviewClearance(hull, part, world_from_part, options, scratch);
  contact.clearance = reviewed.clearance;
  contact.verdict = reviewed.verdict;
  return contact;
}

}  // namespace elbowroom::review
