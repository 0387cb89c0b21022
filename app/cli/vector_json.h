// Points, directions, numbers and spreads in what `--json` prints.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/spread.h"

namespace elbowroom::cli {

// [x, y, z]
[[nodiscard]] inline nlohmann::json JsonOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// null where there is none, or where it is infinite.
[[nodiscard]] inline nlohmann::json OrNull(std::optional<double> number) {
  return number && std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json();
}

// {median, p95, max}; null where nothing was measured.
[[nodiscard]] inline nlohmann::json JsonOf(const std::optional<core::Spread>& spread) {
  if (!spread) return nullptr;
  return {{"median", spread->median}, {"p95", spread->p95}, {"max", spread->max}};
}

}  // namespace elbowroom::cli
