// Touches and near misses as a reviewer's list has them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/control/reviewing/reviewed_session.h"
#include "core/findings/finding.h"
#include "core/ids.h"

namespace elbowroom::control {

struct ListedFinding {
  core::Finding finding;
  std::optional<core::PartIndex> part;  // nothing: the layout has none of that name
  // The deepest frame of a touch, the closest of a near miss: its position among the session's frames.
  // Nothing: the finding isn't in this session.
  std::optional<std::size_t> worst_position;
  double worst_s = 0.0;                // its time; else that of the finding's begin
  std::optional<double> depth_mm;      // of a touch: its deepest, a certified lower bound
  std::optional<double> clearance_mm;  // of a near miss: the upper bound of its least clearance
  std::vector<double> spacing_mm;      // then, in the layout's order
  std::vector<std::string> tools;      // in use then
};

// By time. Thread: any.
[[nodiscard]] std::vector<ListedFinding> ListFindings(const ReviewedSession& session);

}  // namespace elbowroom::control
