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

double PartReviewOptions::EnoughMm() const { return required_clearance_mm + uncertainty_mm + tolerance_mm; }

core::PartContact ReviewPart(const recon::VisualHull& hull, const core::TriangleTree& part,
                             const core::RigidTransform& world_from_part, core::PartIndex part_index,
                             const PartReviewOptions& options, const std::optional<ClearanceHint>& hint,
                             InsideCells* inside, ReviewScratch* scratch) {
  core::PartContact contact =
      FindContacts(hull, part, world_from_part, part_index, options.contacts, inside, scratch);
  if (!(options.required_clearance_mm > 0.0)) return contact;
  if (contact.verdict == core::Verdict::kContact) {
    contact.clearance = ClearanceInContact(contact, part.mesh().deviation_mm);
    return contact;
  }
  ClearanceOptions clearance_options;
  clearance_options.tolerance_mm = options.tolerance_mm;
  clearance_options.enough_mm = options.EnoughMm();
  const Clearance found = FindClearance(hull, part, world_from_part, clearance_options, hint, scratch);
  contact.clearance = core::PartClearance{found.interval, found.has_witnesses, found.queries};
  contact.verdict = Judge(found, options.required_clearance_mm, options.uncertainty_mm);
  return contact;
}

std::optional<ClearanceHint> HintFrom(const core::PartContact& last,
                                      const core::RigidTransform& world_from_part) {
  if (!last.clearance || !last.clearance->has_witnesses) return std::nullopt;
  const core::ClearanceInterval& interval = last.clearance->interval;
  return ClearanceHint{world_from_part.Inverse() * interval.witness_part_in_world_mm,
                       interval.witness_hull_in_world_mm};
}

}  // namespace elbowroom::review
