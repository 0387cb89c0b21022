// From sightings of a board to a calibrated rig.
#pragma once

#include <stop_token>

#include "core/progress.h"
#include "recon/calibration/calibration_input.h"
#include "recon/calibration/calibration_result.h"

namespace elbowroom::recon {

// The whole method of docs/calibration.md: lenses, joining, bundle adjustment, outliers, figures of views
// kept out, covariance. The result is the same for any number of threads. Each true value is within its
// stated 68 % and 95 % region as often as that says (coverage_test).
//
// Throws: what CalibrationInput::Validate throws; Error{kCamera}, one line that names the cameras that can't
// be calibrated and the view to take next; Error{kCancelled} once a stop is requested. Thread: any;
// `progress` is called on the caller's.
[[nodiscard]] CalibrationResult Calibrate(const CalibrationInput& input, const core::Progress& progress = {},
                                          const std::stop_token& stop = {});

}  // namespace elbowroom::recon
