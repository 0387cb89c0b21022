// From pictures of the board to what a calibration is made from.
#pragma once

#include <optional>
#include <vector>

#include "app/control/calibration/board_footage.h"
#include "app/control/calibration/calibration_file.h"
#include "recon/calibration/calibration_input.h"

namespace elbowroom::control {

// While the board lies still for all cameras that see it, its pictures count as one view: a RestingBoard.
//
// `known`: by camera, the lens to keep. Throws: Error{kCamera}: no camera found the board at all, naming what
// was looked for and in how many pictures; a camera that never found it; no camera found it in board_frame.
[[nodiscard]] recon::CalibrationInput ViewsOf(const CalibrationFile& file, const BoardFootage& footage,
                                              std::vector<std::optional<core::CameraCalibration>> known);

}  // namespace elbowroom::control
