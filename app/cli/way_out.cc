#include "app/cli/way_out.h"

#include <fmt/format.h>

#include <vector>

#include "app/cli/options/value_json.h"
#include "core/units.h"
#include "review/recovery.h"

namespace elbowroom::cli {
namespace {

using core::RecoveryKind;
using Eigen::Vector3d;

nlohmann::json DegreesOrNull(const std::optional<double>& angle_rad) {
  return angle_rad ? nlohmann::json(core::DegreesFromRadians(*angle_rad)) : nlohmann::json();
}

// The straight ways that the part may go.
std::vector<Vector3d> DirectionsOf(const review::RecoveryWay& way, const core::Recovery& recovery) {
  if (way.kind == RecoveryKind::kHinge) return {};
  if (way.kind == RecoveryKind::kSlider) return {recovery.v_rec_in_world, -recovery.v_rec_in_world};
  return {recovery.v_rec_in_world};
}

void FreePart(const recon::VisualHull& hull, const core::TriangleTree& part,
              const core::RigidTransform& world_from_part, const core::Recovery& recovery, WayOut* way_out) {
  for (const Vector3d& direction : DirectionsOf(way_out->way, recovery)) {
    review::EscapeOptions options;
    if (way_out->part_free) options.give_up_mm = way_out->part_free->upper_mm;
    std::vector<Vector3d> witnesses;
    const review::EscapeDistance escape =
        review::FindEscapeDistance(hull, part, world_from_part, direction, &witnesses, options);
    if (way_out->part_free && !(escape.upper_mm < way_out->part_free->upper_mm)) continue;
    way_out->part_free = escape;
    way_out->part_free_direction_in_world = direction;
  }
}

nlohmann::json RecoveryJson(const core::PartContact& contact, const WayOut& way_out) {
  const review::RecoveryWay& way = way_out.way;
  const bool has_axis = way.kind != RecoveryKind::kReference;
  nlohmann::json json = {{"kind", core::ToString(way.kind)},
                         {"reference_mm", JsonOf(way.rp_obj)},
                         {"axis", has_axis ? JsonOf(way.axis) : nlohmann::json()},
                         {"at_mm", way.kind == RecoveryKind::kHinge ? JsonOf(way.at_mm) : nlohmann::json()},
                         {"sense", nullptr},
                         {"angle_deg", nullptr},
                         {"part_free_mm", nullptr},
                         {"part_free_direction", nullptr},
                         {"part_leaves_workspace", nullptr}};
  if (contact.recovery) {
    const double along = contact.recovery->angle_rad.value_or(contact.recovery->v_rec_in_world.dot(way.axis));
    if (has_axis) json["sense"] = along < 0.0 ? "-" : "+";
    json["angle_deg"] = DegreesOrNull(contact.recovery->angle_rad);
  }
  if (way_out.part_free) {
    json["part_free_mm"] = {way_out.part_free->lower_mm, way_out.part_free->upper_mm};
    json["part_free_direction"] = JsonOf(*way_out.part_free_direction_in_world);
    json["part_leaves_workspace"] = way_out.part_free->leaves_workspace;
  }
  return json;
}

nlohmann::json UncertaintyJson(const std::optional<review::RecoveryUncertainty>& uncertainty) {
  if (!uncertainty) return {};
  return {{"cp_obj_mm", uncertainty->cp_obj_mm},
          {"v_rec_deg", DegreesOrNull(uncertainty->v_rec_rad)},
          {"d_rec_mm", OrNull(uncertainty->d_rec_mm)},
          {"cp_hull_mm", OrNull(uncertainty->cp_hull_mm)},
          {"n_hull_deg", DegreesOrNull(uncertainty->n_hull_rad)},
          {"at_edge", uncertainty->is_at_edge}};
}

}  // namespace

WayOut FindWayOut(const recon::VisualHull& hull, const core::TriangleTree& part,
                  const core::RigidTransform& world_from_part, const core::RecoveryRule& rule,
                  const core::PartContact& contact, double silhouette_px) {
  WayOut way_out;
  if (contact.verdict != core::Verdict::kContact) return way_out;
  way_out.way = review::WayOf(rule, part, world_from_part);
  if (contact.recovery) {
    way_out.uncertainty = review::UncertaintyOf(hull, contact, way_out.way, silhouette_px);
    FreePart(hull, part, world_from_part, *contact.recovery, &way_out);
  }
  way_out.penetration = review::FindPenetration(hull, part, world_from_part, contact);
  return way_out;
}

void AddWayOut(const core::PartContact& contact, const WayOut& way_out, nlohmann::json* json) {
  const std::optional<review::Penetration>& penetration = way_out.penetration;
  (*json)["status"] = ToString(contact.recovery_status);
  (*json)["recovery"] = penetration ? RecoveryJson(contact, way_out) : nlohmann::json();
  (*json)["uncertainty"] = UncertaintyJson(way_out.uncertainty);
  (*json)["penetration_mm"] = nullptr;
  (*json)["penetration_direction"] = nullptr;
  (*json)["penetration_leaves_workspace"] = nullptr;
  (*json)["penetration_queries"] = nullptr;
  if (!penetration) return;
  (*json)["penetration_mm"] = {penetration->lower_mm, penetration->upper_mm};
  (*json)["penetration_direction"] = JsonOf(penetration->direction_in_world);
  (*json)["penetration_leaves_workspace"] = penetration->leaves_workspace;
  (*json)["penetration_queries"] = penetration->queries;
}

std::string TextOf(const core::PartContact& contact, const WayOut& way_out) {
  std::string text;
  if (contact.recovery) text += fmt::format("; back by {:.2f} mm", contact.recovery->d_rec_mm);
  if (contact.recovery_status != core::RecoveryStatus::kFound)
    text += fmt::format(" ({})", ToString(contact.recovery_status));
  if (way_out.penetration)
    text += fmt::format("; shortest way out {:.2f} to {:.2f} mm", way_out.penetration->lower_mm,
                        way_out.penetration->upper_mm);
  return text;
}

}  // namespace elbowroom::cli
