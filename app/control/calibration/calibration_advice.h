// What a calibration lacks, and what to do about it, in plain words.
#pragma once

#include <string>
#include <vector>

#include "recon/calibration/calibration_input.h"
#include "recon/calibration/calibration_result.h"

namespace elbowroom::control {

// One line each, the most useful first: parts of a picture in which a camera hasn't seen the board, cameras
// with few views or with views that aren't tilted, pairs of cameras that share few sets, cameras whose time
// offset can't be told.
[[nodiscard]] std::vector<std::string> AdviceFor(const recon::CalibrationInput& input,
                                                 const recon::CalibrationResult& result);

}  // namespace elbowroom::control
