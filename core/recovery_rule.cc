#include "core/recovery_rule.h"

#include <array>
#include <cstddef>

namespace elbowroom::core {
namespace {

constexpr std::array<std::string_view, 4> kKinds = {"reference", "direction", "slider", "hinge"};

bool IsFinite(const std::optional<Eigen::Vector3d>& vector) { return !vector || vector->allFinite(); }

}  // namespace

std::string_view ToString(RecoveryKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

std::optional<RecoveryKind> ParseRecoveryKind(std::string_view text) {
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (kKinds[i] == text) return static_cast<RecoveryKind>(i);
  }
  return std::nullopt;
}

std::optional<std::string_view> RecoveryRule::BrokenRule() const {
  if (!IsFinite(reference_in_part_mm) || !IsFinite(axis_in_part) || !IsFinite(at_in_part_mm))
    return "its numbers must be finite";
  const bool has_axis = kind != RecoveryKind::kReference, has_point = kind == RecoveryKind::kHinge;
  if (has_axis && !axis_in_part) return "a direction, slider or hinge needs an axis; add it";
  if (!has_axis && axis_in_part)
    return "an axis has no meaning towards the reference; choose direction, slider or hinge, or remove it";
  if (axis_in_part && !(axis_in_part->stableNorm() > 0.0)) return "the axis must not be zero";
  if (has_point && !at_in_part_mm) return "a hinge needs a point of its axis; add it";
  if (!has_point && at_in_part_mm) return "only a hinge has a point of its axis; remove it";
  return std::nullopt;
}

}  // namespace elbowroom::core
