// The smallest gap at which the recorded motion has the space that it needs.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "app/control/reviewing/reviewed_session.h"
#include "core/progress.h"

namespace elbowroom::control {

inline constexpr double kNeededGapStepMm = 5.0;

struct NeededGap {
  std::optional<double> touched_mm;  // the largest gap found at which a moved part is touched
  // The smallest one found at which surely none is touched, as at all gaps above; within 0.5 mm of
  // touched_mm. Nothing: even the largest gap is touched.
  std::optional<double> free_mm;
  // The smallest step from which on the required clearance is sure. A step is kNeededGapStepMm, or a
  // hundredth of the range if that is more. Nothing: none is, or none is required.
  std::optional<double> clear_mm;
};

// What `elbowroom sweep` finds over the spacing's whole range: frames in which a camera is missing are left
// out, parts stand where they are before they give way, and other spacings have their recorded values.
// Throws: core::Error{kRange}: no such spacing, no frame with all cameras; {kCancelled}; what SessionReader
// throws. Thread: any.
[[nodiscard]] NeededGap FindNeededGap(const ReviewedSession& session, const std::string& spacing,
                                      const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
