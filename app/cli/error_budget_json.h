// What a verdict allows for, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "core/error_budget.h"

namespace elbowroom::cli {

[[nodiscard]] inline nlohmann::json JsonOf(const core::ErrorBudget& budget) {
  return {{"calibration_mm", budget.calibration_mm},
          {"footprint_mm", budget.footprint_mm},
          {"segmentation_mm", budget.segmentation_mm},
          {"skew_mm", budget.skew_mm},
          {"given_mm", budget.given_mm},
          {"coverage_factor", core::kCoverageFactor}};
}

}  // namespace elbowroom::cli
