// Points and views that don't agree with the fit.
#pragma once

#include <string>
#include <vector>

#include "recon/calibration/adjustment.h"

namespace elbowroom::recon {

inline constexpr double kPointSigmas = 5.0;  // a point beyond so many standard deviations is left out
inline constexpr double kViewMedians = 3.0;  // a view whose RMS is beyond so many times its camera's median

// The median residual of all points of each view, over the sightings' standard deviations. Views and points
// that aren't used count, too.
[[nodiscard]] std::vector<double> ViewMedians(const Adjustment& adjustment);

// Decides anew which points and views of an adjustment are used. A point is left out beyond kPointSigmas
// times `noise_scale`. A view is left out if more than half of its points are, or fewer than four remain, or
// its RMS is beyond kViewMedians times its camera's median, which is taken over the used views. Returns
// whether anything changed. Views that aren't used stay so.
bool LeaveOutliers(double noise_scale, Adjustment* adjustment);

}  // namespace elbowroom::recon
