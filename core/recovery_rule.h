// Which way a part may give way to the hull.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "core/rigid_transform.h"

namespace elbowroom::core {

enum class RecoveryKind {
  kReference,  // straight towards RP_obj: the paper's
  kDirection,  // along the axis, in its sense alone
  kSlider,     // along the axis, in the sense that is shorter
  kHinge,      // about the axis, in the sense that is shorter
};

[[nodiscard]] std::string_view ToString(RecoveryKind kind);  // "reference", "direction", "slider", "hinge"
[[nodiscard]] std::optional<RecoveryKind> ParseRecoveryKind(std::string_view text);

// The constraint of one part, in the frame that its name ends in; CP_obj is always the contact point farthest
// from RP_obj, whatever the kind.
struct RecoveryRule {
  RecoveryKind kind = RecoveryKind::kReference;
  std::optional<Eigen::Vector3d> reference_in_part_mm;  // RP_obj; nothing: the centre of the part's bounds
  std::optional<Eigen::Vector3d> axis_in_part;          // of any length but 0; none with kReference
  std::optional<Eigen::Vector3d> at_in_part_mm;         // a point of the hinge's axis; with kHinge alone

  // What is wrong with it, as one line that says what to do; nothing: it can be used.
  [[nodiscard]] std::optional<std::string_view> BrokenRule() const;

  [[nodiscard]] bool operator==(const RecoveryRule&) const = default;
};

}  // namespace elbowroom::core
