// The covariance of a fitted rig.
#pragma once

#include <Eigen/Core>

#include "recon/calibration/adjustment.h"
#include "recon/calibration/calibration_input.h"

namespace elbowroom::recon {

// Covariance of all parameters of an Adjustment's cameras, flatness last; 0 for what is fixed. `input`: for
// the cameras' names. Throws: Error{kCamera} if the views don't decide all parameters, naming the camera of
// which they decide least and the next view.
[[nodiscard]] Eigen::MatrixXd CovarianceOf(const Adjustment& adjustment, double noise_scale,
                                           const CalibrationInput& input);

}  // namespace elbowroom::recon
