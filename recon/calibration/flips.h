// Planar boards whose mirrored pose fits better.
#pragma once

#include <vector>

#include "recon/calibration/bundle.h"
#include "recon/calibration/planar_pose.h"
#include "recon/calibration/rig_state.h"

namespace elbowroom::recon {

// Whose mirror images are tried: of all boards that leave a doubt, or of those that fit worse than the noise.
enum class FlipsTried { kOfDoubtful, kOfMisfits };

// Exchanges the poses of boards whose mirror image fits better and takes the adjustment over into the state;
// returns whether there were any. A flip of the world's board moves the world. A board leaves no doubt if two
// cameras confirm its pose that see it from directions 0.3 rad apart: they don't agree on a mirrored one.
// `options`: noise scale and loss.
bool ExchangeFlips(FlipsTried tried, const BundleOptions& options, Adjustment* adjustment, RigState* state);

// The used views of each board, at its instant.
[[nodiscard]] std::vector<std::vector<PosedView>> ViewsOfBoards(const Adjustment& adjustment);

// The best of the minima near the mirror images of a board's pose, at the line of sight of each of its views.
[[nodiscard]] PoseFit BestFlip(const std::vector<PosedView>& views, const PoseFit& kept,
                               const Eigen::Vector3d& center_in_board, double cauchy_scale);

}  // namespace elbowroom::recon
