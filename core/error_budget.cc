#include "core/error_budget.h"

#include <cmath>

namespace elbowroom::core {

double ErrorBudget::CombinedMm() const {
  return std::sqrt(calibration_mm * calibration_mm + footprint_mm * footprint_mm +
                   segmentation_mm * segmentation_mm + skew_mm * skew_mm + given_mm * given_mm);
}

}  // namespace elbowroom::core
