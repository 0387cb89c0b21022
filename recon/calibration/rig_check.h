// Holds a rig that somebody else calibrated against pictures of a board.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/camera_model.h"
#include "core/rigid_transform.h"
#include "recon/calibration/calibration_input.h"

namespace elbowroom::recon {

// How well a rig explains where its cameras see the board.
struct RigCheck {
  // The median, over the views, of the root mean square of a point's distance from where it should be.
  double error_px = 0.0;
  std::vector<std::optional<double>> camera_error_px;  // the same by camera; nothing: no view of it counts
  double scale = 1.0;  // by which the rig's lengths must be multiplied to be mm, as the board's size tells
  int sets = 0;        // of the sets that two cameras or more see, those that were looked at
  int views = 0;
};

// The board's pose in each set is fitted to all of the set's views with the rig as it is, and so is one scale
// of the rig for all sets. Without `scale` it is searched; with it, it is kept. In footage of cameras that
// share no clock, the half of the sets in which the board moves the least counts. Views for a lens alone
// don't count. `cameras`: as in `input`, whose own lenses and world aren't used. Nothing: no set that two
// cameras see, or the rig's cameras stand in one place. Throws: Error{kCamera} as core::CameraModel.
[[nodiscard]] std::optional<RigCheck> CheckRig(const CalibrationInput& input,
                                               std::span<const core::CameraCalibration> cameras,
                                               std::optional<double> scale = std::nullopt);

// World_from_board in the set with that number, for a rig in mm, fitted to the set's views. The first
// camera's view keeps its numbers. Nothing: no camera sees the board there, or one alone, and its two
// possible poses reproject alike (their errors differ by less than a factor of 2).
[[nodiscard]] std::optional<core::RigidTransform> BoardInSet(const CalibrationInput& input,
                                                             std::span<const core::CameraCalibration> cameras,
                                                             int set);

// Whether two rigs are the same but for the place of their world and their scale: relative rotations to 0.1
// degree, relative centres to 1 % of the rig's size.
[[nodiscard]] bool AreTheSameRig(std::span<const core::CameraCalibration> a,
                                 std::span<const core::CameraCalibration> b);

}  // namespace elbowroom::recon
