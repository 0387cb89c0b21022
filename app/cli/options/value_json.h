// Points, directions, numbers, spreads and error budgets in what `--json` prints.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error_budget.h"
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

// What a verdict allows for.
[[nodiscard]] inline nlohmann::json JsonOf(const core::ErrorBudget& budget) {
  return {{"calibration_mm", budget.calibration_mm},
          {"footprint_mm", budget.footprint_mm},
          {"segmentation_mm", budget.segmentation_mm},
          {"skew_mm", budget.skew_mm},
          {"given_mm", budget.given_mm},
          {"coverage_factor", core::kCoverageFactor}};
}

}  // namespace elbowroom::cli
