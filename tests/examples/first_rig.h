// The rig of docs/examples/first_rig: its truth, and how its pictures were made.
#pragma once

#include <filesystem>
#include <vector>

#include "core/camera_model.h"
#include "recon/boards/board.h"

namespace elbowroom::examples {

inline constexpr int kBoardSets = 16;   // the first on the table
inline constexpr int kRodFrames = 9;    // of the trial, at its beginning: places of the rod
inline constexpr int kHandFrames = 12;  // then the hand comes, touches the part, and goes
inline constexpr double kRodDiameterMm = 20.0;
inline constexpr double kRodLengthMm = 120.0;

[[nodiscard]] recon::Board FirstBoard();

// Three cameras of 400 x 300 around a table, in the board's world.
[[nodiscard]] std::vector<core::CameraCalibration> FirstCameras();

// Draws camN/board_NN.jpg, camN/empty.jpg and camN/trial_NN.jpg into `folder`. The same pictures each time.
void DrawFirstRig(const std::filesystem::path& folder);

}  // namespace elbowroom::examples
