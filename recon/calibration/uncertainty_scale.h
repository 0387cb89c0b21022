// Whether the residuals of a view are independent, as the covariance takes them to be.
#pragma once

#include <stop_token>

#include "recon/calibration/rig_fit.h"

namespace elbowroom::recon {

// What all standard deviations are to be multiplied by, 1 at least. Each view pulls on the cameras; at the
// minimum the pulls add up to nothing, and their spread is what makes the cameras uncertain. Where a view's
// residuals are off together (a rolling shutter, a jerk between the instants of a set, a lens that its model
// doesn't fit) the spread is larger than that of the same rig with independent noise of the same size, which
// is drawn (fixed seed): the root of the ratio is the result, if it is above 1.25. Throws: Error{kCancelled}.
[[nodiscard]] double UncertaintyScale(const RigFit& fit, const std::stop_token& stop);

}  // namespace elbowroom::recon
