#include "app/control/trial_rules.h"

namespace elbowroom::control {

review::PartReviewOptions ReviewOptionsOf(const core::TrialInfo& trial) {
  review::PartReviewOptions options;
  options.required_clearance_mm = trial.required_clearance_mm;
  options.uncertainty_mm = trial.uncertainty_mm;
  return options;
}

review::TrackerOptions TrackerOptionsOf(const core::TrialInfo& trial) {
  review::TrackerOptions options;
  options.required_clearance_mm = trial.required_clearance_mm;
  options.uncertainty_mm = trial.uncertainty_mm;
  options.leave_margin_mm = ReviewOptionsOf(trial).tolerance_mm;
  return options;
}

}  // namespace elbowroom::control
