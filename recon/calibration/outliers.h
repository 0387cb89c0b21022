// Points and views that don't agree with the fit.
#pragma once

#include <string>
#include <vector>

#include "recon/calibration/adjustment.h"

namespace elbowroom::recon {

inline constexpr double kPointSigmas = 5.0;  // a point beyond so many standard deviations is left out
inline constexpr double kViewSigmas = 5.0;   // so is a view whose RMS is so far above its camera's median
inline constexpr double kViewMedians = 3.0;  // or beyond so many times the median

// The median residual of all points of each view, over the sightings' standard deviations. Views and points
// that aren't used count, too.
[[nodiscard]] std::vector<double> ViewMedians(const Adjustment& adjustment);

// Decides anew which points and views of an adjustment are used; returns whether anything changed. Views that
// aren't used stay so.
//
// A point is left out beyond kPointSigmas times `noise_scale`. A view is left out if more than half of its
// points are, or fewer than four remain, or all on a line, or its RMS is too large. How far the RMS of n
// points is from the camera's median is measured in its standard deviation, 1 / sqrt(4 n) of the median,
// times the spread that the camera's views have by this measure, where that is more than 1. Of views that
// share a board, only the worst goes at a time: the others may be off because of it.
bool LeaveOutliers(double noise_scale, Adjustment* adjustment);

}  // namespace elbowroom::recon
