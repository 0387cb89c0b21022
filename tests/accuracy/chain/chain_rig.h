// A rig as somebody builds it, and what `calibrate` makes of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/progress.h"
#include "core/rig.h"
#include "core/rig_quality.h"

namespace elbowroom::accuracy {

struct ChainRigOptions {
  int cameras = 4;
  int board_poses = 25;        // beside the board on the table
  double picture_scale = 1.0;  // 1: 640 x 480
};

// World, of both rigs: the calibration board as it lies on the table, which is z = 0.
struct ChainRig {
  core::Rig truth;
  core::Rig estimate;            // what the program knows
  core::RigQuality quality;      // of the estimate
  double held_out_px = 0.0;      // RMS of the calibration's views kept out
  double center_error_mm = 0.0;  // of the cameras, the mean
};

// Above the table's middle, about which the rig stands and objects move.
[[nodiscard]] Eigen::Vector3d ChainMiddleInWorld();

// Cameras around the table, pictures of a board before them, and control::CalibrateRig, the code behind
// `calibrate`, on their files. The same for the same seed. Throws: what CalibrateRig throws.
[[nodiscard]] ChainRig MakeChainRig(const ChainRigOptions& options, std::uint64_t seed,
                                    const core::Progress& progress = {});

}  // namespace elbowroom::accuracy
