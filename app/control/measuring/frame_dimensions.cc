#include "app/control/measuring/frame_dimensions.h"

#include <fmt/format.h>

#include <cmath>

namespace elbowroom::control {
namespace {

void AddOfPart(const core::PartContact& contact, std::vector<Dimension>* dimensions) {
  if (contact.verdict == core::Verdict::kContact) {
    if (!contact.deepest) return;
    const Eigen::Vector3d& at = contact.deepest->position_in_world_mm;
    dimensions->push_back(
        {at, at, fmt::format("≥ {:.1f} mm deep", std::floor(10.0 * contact.deepest->depth_mm) / 10.0),
         contact.verdict});
    return;
  }
  if (!contact.clearance || !contact.clearance->has_witnesses) return;
  const core::ClearanceInterval& interval = contact.clearance->interval;
  if (!std::isfinite(interval.upper_mm)) return;
  dimensions->push_back({interval.witness_part_in_world_mm, interval.witness_hull_in_world_mm,
                         IntervalText(interval.lower_mm, interval.upper_mm), contact.verdict});
}

}  // namespace

std::string IntervalText(double lower_mm, double upper_mm) {
  return fmt::format("{:.1f} – {:.1f} mm", std::floor(10.0 * lower_mm) / 10.0,
                     std::ceil(10.0 * upper_mm) / 10.0);
}

std::vector<Dimension> DimensionsOf(const FrameResult& result) {
  std::vector<Dimension> dimensions;
  for (const core::PartContact& contact : result.record.contacts) AddOfPart(contact, &dimensions);
  if (!result.pairs) return dimensions;
  for (const review::PairClash& pair : result.pairs->pairs) {
    if (!pair.gap) continue;
    dimensions.push_back(
        {pair.gap->on_a, pair.gap->on_b, fmt::format("{:.1f} mm", pair.gap->distance_mm), pair.verdict});
  }
  return dimensions;
}

}  // namespace elbowroom::control
