// The options of the review that follow from a trial's values.
#pragma once

#include "core/rig.h"
#include "core/rig_quality.h"
#include "core/session.h"
#include "review/contact_tracker.h"
#include "review/part_review.h"

namespace elbowroom::control {

// What a verdict allows for is computed where the rig's quality has errors, else it is the trial's. Throws:
// PreconditionError: errors of another rig.
[[nodiscard]] review::PartReviewOptions ReviewOptionsOf(const core::TrialInfo& trial, const core::Rig& rig,
                                                        const core::RigQuality& quality);
[[nodiscard]] review::TrackerOptions TrackerOptionsOf(const core::TrialInfo& trial);

}  // namespace elbowroom::control
