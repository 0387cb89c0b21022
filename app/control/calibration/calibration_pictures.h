// The pictures of a calibration's report, as SVG.
#pragma once

#include <string>

#include "app/control/calibration/calibration_job.h"

namespace elbowroom::control {

// One camera's picture: where it saw the board's points, each with its residual as a line, enlarged. Points
// that are left out are crosses.
[[nodiscard]] std::string ResidualPicture(const CalibrationOutcome& outcome, int camera);

// The workspace from above at three heights, y upwards, coloured by the error of a point in mm. Grey: fewer
// than two cameras see it. Empty if that is so everywhere.
[[nodiscard]] std::string UncertaintyPicture(const CalibrationOutcome& outcome);

}  // namespace elbowroom::control
