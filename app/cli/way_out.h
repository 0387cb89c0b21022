// How a contact can be undone, and how that is printed.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/bvh.h"
#include "core/contact.h"
#include "core/recovery_rule.h"
#include "core/rigid_transform.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/escape_distance.h"
#include "review/penetration.h"
#include "review/recovery_uncertainty.h"

namespace elbowroom::cli {

// How one contact can be undone; empty without a contact.
struct WayOut {
  review::RecoveryWay way;
  std::optional<review::RecoveryUncertainty> uncertainty;
  std::optional<review::EscapeDistance> part_free;  // only for a straight way
  std::optional<Eigen::Vector3d> part_free_direction_in_world;
  std::optional<review::Penetration> penetration;
};

[[nodiscard]] WayOut FindWayOut(const recon::VisualHull& hull, const core::TriangleTree& part,
                                const core::RigidTransform& world_from_part, const core::RecoveryRule& rule,
                                const core::PartContact& contact, double silhouette_px);

// Adds `status`, `recovery`, `uncertainty`, `penetration_mm` and the like; null where without meaning.
void AddWayOut(const core::PartContact& contact, const WayOut& way_out, nlohmann::json* json);

[[nodiscard]] std::string TextOf(const core::PartContact& contact, const WayOut& way_out);

}  // namespace elbowroom::cli
