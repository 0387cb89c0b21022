#include "sessions/row_comparison.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "sessions/frame_rows.h"

namespace elbowroom::sessions {
namespace {

bool IsSame(const core::ContactPoint& a, const core::ContactPoint& b) {
  return std::tie(a.position_in_world_mm, a.depth_mm, a.area_mm2) ==
         std::tie(b.position_in_world_mm, b.depth_mm, b.area_mm2);
}

bool IsSame(const core::Recovery& a, const core::Recovery& b) {
  return std::tie(a.cp_obj_in_world_mm, a.cp_hull_in_world_mm, a.v_rec_in_world, a.d_rec_mm,
                  a.n_hull_in_world, a.angle_rad) == std::tie(b.cp_obj_in_world_mm, b.cp_hull_in_world_mm,
                                                              b.v_rec_in_world, b.d_rec_mm, b.n_hull_in_world,
                                                              b.angle_rad);
}

bool IsSame(const core::PartClearance& a, const core::PartClearance& b) {
  if (a.interval.lower_mm != b.interval.lower_mm || a.interval.upper_mm != b.interval.upper_mm ||
      a.has_witnesses != b.has_witnesses || a.queries != b.queries || a.budget != b.budget)
    return false;
  return !a.has_witnesses || (a.interval.witness_part_in_world_mm == b.interval.witness_part_in_world_mm &&
                              a.interval.witness_hull_in_world_mm == b.interval.witness_hull_in_world_mm);
}

template <typename Value>
bool IsSame(const std::optional<Value>& a, const std::optional<Value>& b) {
  return a.has_value() == b.has_value() && (!a || IsSame(*a, *b));
}

bool IsSame(const core::PartContact& a, const core::PartContact& b) {
  return std::tie(a.part, a.verdict, a.contact_point_count, a.contact_area_mm2, a.recovery_status,
                  a.resolution_mm, a.count.triangles, a.count.queries, a.count.skipped) ==
             std::tie(b.part, b.verdict, b.contact_point_count, b.contact_area_mm2, b.recovery_status,
                      b.resolution_mm, b.count.triangles, b.count.queries, b.count.skipped) &&
         IsSame(a.deepest, b.deepest) && IsSame(a.recovery, b.recovery) && IsSame(a.clearance, b.clearance) &&
         std::ranges::equal(a.points, b.points, [](const auto& p, const auto& q) { return IsSame(p, q); });
}

// Parts that stand where layout and spacings have them have no row.
std::vector<core::RigidTransform> MotionsWithRows(const core::FrameRecord& record) {
  std::vector<core::RigidTransform> motions = record.rest_from_parts;
  motions.resize(record.contacts.size());
  return motions;
}

std::int64_t RowsOf(const core::FrameRecord& record) {
  std::int64_t rows = 0;
  for (const core::PartContact& contact : record.contacts)
    rows += 1 + (contact.clearance ? 1 : 0) + (HasContactRow(contact) ? 1 : 0) +
            static_cast<std::int64_t>(contact.points.size());
  return rows + std::ranges::count_if(record.rest_from_parts, [](const core::RigidTransform& motion) {
           return !(motion == core::RigidTransform());
         });
}

}  // namespace

RowComparison CompareRows(const core::FrameRecord& recorded, const core::FrameRecord& replayed) {
  RowComparison comparison{RowsOf(recorded), false};
  comparison.are_equal = std::ranges::equal(recorded.contacts, replayed.contacts,
                                            [](const auto& a, const auto& b) { return IsSame(a, b); }) &&
                         recorded.spacing_mm == replayed.spacing_mm &&
                         MotionsWithRows(recorded) == MotionsWithRows(replayed);
  return comparison;
}

}  // namespace elbowroom::sessions
