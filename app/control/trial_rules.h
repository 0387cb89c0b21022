// The options of the review that follow from a trial's values.
#pragma once

#include "core/session.h"
#include "review/contact_tracker.h"
#include "review/part_review.h"

namespace elbowroom::control {

[[nodiscard]] review::PartReviewOptions ReviewOptionsOf(const core::TrialInfo& trial);
[[nodiscard]] review::TrackerOptions TrackerOptionsOf(const core::TrialInfo& trial);

}  // namespace elbowroom::control
