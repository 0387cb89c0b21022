// From CALIB.toml to a calibrated rig, its figures, and what to do next.
#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/calibration/board_footage.h"
#include "app/control/calibration/calibration_file.h"
#include "core/progress.h"
#include "core/spread.h"
#include "recon/calibration/calibration_input.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/known_length.h"
#include "recon/calibration/rig_uncertainty.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

struct CalibrationOutcome {
  BoardFootage footage;
  recon::CalibrationInput input;
  recon::CalibrationResult result;
  recon::UncertaintyMap map;                   // over the workspace
  std::optional<core::Spread> uncertainty_mm;  // of the map's nodes; nothing: two cameras see none of them
  double seen_share = 0.0;                     // of the map's nodes, those that two cameras see
  std::vector<recon::LengthCheck> lengths;
  bool scale_checked = false;
  std::vector<std::string> warnings;  // plain lines
  std::vector<std::string> advice;
  recon::RigFile rig_file;
  double time_ms = 0.0;  // from sightings to the map
};

// Throws: what FindBoards, ViewsOf and recon::Calibrate throw; Error{kCancelled} on a stop.
[[nodiscard]] CalibrationOutcome CalibrateRig(const CalibrationFile& file, const std::string& rig_name,
                                              const core::Progress& progress, const std::stop_token& stop);

}  // namespace elbowroom::control
