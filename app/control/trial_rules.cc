#include "app/control/trial_rules.h"

#include <memory>

namespace elbowroom::control {

review::PartReviewOptions ReviewOptionsOf(const core::TrialInfo& trial, const core::Rig& rig,
                                          const core::RigQuality& quality) {
  review::PartReviewOptions options;
  options.required_clearance_mm = trial.required_clearance_mm;
  options.uncertainty_mm = trial.uncertainty_mm;
  if (quality.errors) options.hull_errors = std::make_shared<const recon::HullErrors>(rig, *quality.errors);
  options.is_rig_refuted = quality.is_refuted();
  return options;
}

review::TrackerOptions TrackerOptionsOf(const core::TrialInfo& trial) {
  review::TrackerOptions options;
  options.required_clearance_mm = trial.required_clearance_mm;
  options.uncertainty_mm = trial.uncertainty_mm;
  options.leave_margin_mm = review::PartReviewOptions().tolerance_mm;
  return options;
}

}  // namespace elbowroom::control
