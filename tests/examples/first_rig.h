// The rig of docs/examples/first_rig: its truth, and how its pictures were made.
#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "recon/boards/board.h"

namespace elbowroom::examples {

inline constexpr int kBoardSets = 20;   // the first on the table
inline constexpr int kRodFrames = 9;    // of the trial, at its beginning: places of the rod
inline constexpr int kHandFrames = 12;  // then the hand comes, touches the part, and goes
inline constexpr double kRodDiameterMm = 20.0;
inline constexpr double kRodLengthMm = 120.0;

[[nodiscard]] recon::Board FirstBoard();

// Three cameras of 480 x 360 around a table, in the board's world.
[[nodiscard]] std::vector<core::CameraCalibration> FirstCameras();

// z of the hand's highest point above the rectangle (x, y) of the world, over its frames; nothing: it isn't
// there.
[[nodiscard]] std::optional<double> HighestOfHandMm(const Eigen::AlignedBox2d& above_mm);

// Draws camN/board_NN.jpg, camN/empty.jpg and camN/trial_NN.jpg into `folder`, the same each time; or only
// those of these names ("cam1/empty.jpg").
void DrawFirstRig(const std::filesystem::path& folder, const std::vector<std::string>& only = {});

}  // namespace elbowroom::examples
