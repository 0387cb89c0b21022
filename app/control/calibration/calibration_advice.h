// What a calibration lacks, and what to do about it, in plain words.
#pragma once

#include <string>
#include <vector>

#include "recon/calibration/calibration_input.h"
#include "recon/calibration/calibration_result.h"

namespace elbowroom::control {

// One line each, camera by camera: parts of its picture in which it hasn't seen the board, few views; then
// cameras that share few instants with any other, where the board makes the world.
[[nodiscard]] std::vector<std::string> AdviceFor(const recon::CalibrationInput& input,
                                                 const recon::CalibrationResult& result);

}  // namespace elbowroom::control
