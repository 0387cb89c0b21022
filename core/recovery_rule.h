// The way along which a part may leave the hull.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "core/rigid_transform.h"

namespace elbowroom::core {

enum class RecoveryKind {
  kReference,  // straight towards RP_obj, as in the paper
  kDirection,  // along the axis, only in its sense
  kSlider,     // along the axis, in the sense with the shorter way
  kHinge,      // about the axis, in the sense with the shorter way
};

[[nodiscard]] std::string_view ToString(RecoveryKind kind);  // "reference", "direction", "slider", "hinge"
[[nodiscard]] std::optional<RecoveryKind> ParseRecoveryKind(std::string_view text);

// The constraint of one part. CP_obj is the contact point farthest from RP_obj, whatever the kind.
struct RecoveryRule {
  RecoveryKind kind = RecoveryKind::kReference;
  std::optional<Eigen::Vector3d> reference_in_part_mm;  // RP_obj; nothing: the centre of the part's bounds
  std::optional<Eigen::Vector3d> axis_in_part;          // of any length but 0; nothing with kReference
  std::optional<Eigen::Vector3d> at_in_part_mm;         // a point of the hinge's axis; only with kHinge

  // One line that says what is wrong and what to do. Nothing: the rule can be used.
  [[nodiscard]] std::optional<std::string_view> BrokenRule() const;

  [[nodiscard]] bool operator==(const RecoveryRule&) const = default;
};

}  // namespace elbowroom::core
