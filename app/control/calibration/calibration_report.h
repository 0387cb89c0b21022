// A calibration as a page to read.
#pragma once

#include <filesystem>
#include <vector>

#include "app/control/calibration/calibration_job.h"

namespace elbowroom::control {

// Writes report.html, which needs no other file, and residuals.csv into `folder`, whole or not at all.
// Returns their paths. Throws: Error{kFile} naming what can't be written.
std::vector<std::filesystem::path> WriteCalibrationReport(const CalibrationFile& file,
                                                          const CalibrationOutcome& outcome,
                                                          const std::filesystem::path& folder);

}  // namespace elbowroom::control
