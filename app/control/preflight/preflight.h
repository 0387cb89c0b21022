// Whether a trial can begin: what was found of its rig, row by row, and what to do about it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/control/cameras/camera_check.h"
#include "core/spread.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::control {

enum class PreflightState {
  kWell,
  kAttention,  // a trial can run, but something should be done first
  kFault,      // a trial can't run, or its verdicts would be worth nothing
};

struct PreflightRow {
  std::string subject;  // "Background", or a camera's name
  PreflightState state = PreflightState::kWell;
  std::string finding;              // what is, in one line
  std::vector<std::string> advice;  // a sentence each, the most urgent first; empty where all is well
};

// How exactly the rig knows a point in its workspace, 1 sigma, mm, by its covariance, over the places that
// two cameras or more see. Nothing: the rig has no covariance, or there is no such place.
[[nodiscard]] std::optional<core::Spread> PointErrorsMm(const recon::RigFile& rig_file);

// Of a calibration's `made`, for example "2026-11-25T09:30:00Z"; nothing: it is no such time.
[[nodiscard]] std::optional<double> DaysSince(const std::string& made_utc, const std::string& now_utc);

// What the rig as a whole is like, without its cameras: background, calibration, disk space where sessions
// are written (`session_folder`; one that isn't there yet counts as the folder that it will be in).
[[nodiscard]] std::vector<PreflightRow> RigRows(const recon::RigFile& rig_file,
                                                const std::filesystem::path& session_folder);

// A row a camera, and one for the rig's frames.
[[nodiscard]] std::vector<PreflightRow> CameraRows(const RigHealth& health);

}  // namespace elbowroom::control
