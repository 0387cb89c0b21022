// From a rig's start to its final parameters: robust fits, offsets, outliers, flips.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "recon/calibration/rig_state.h"

namespace elbowroom::recon {

struct RigFit {
  RigState state;
  Adjustment adjustment;  // as AdjustmentOf(state) at the end
  double noise_scale = 1.0;
  std::vector<std::string> warnings;
};

// Poses, then lenses too, then offsets and flatness, with a robust loss; then plain least squares without the
// points and views that don't agree, until nothing changes (eight rounds at most). Where the input names no
// model, each camera's is chosen then (lens_choice.h), and the fit made again if one changes. A board's pose
// whose mirror image fits its views better is exchanged for it; a view that would see the board from behind
// isn't used. Throws: Error{kCamera} naming a camera of which too little agrees with the others, and the next
// view; Error{kCancelled}.
[[nodiscard]] RigFit FitRig(RigState start, const std::stop_token& stop);

// Plain least squares over what the state uses; the state takes it over.
[[nodiscard]] Adjustment FitPlainly(RigState* state, double noise_scale, int most_steps,
                                    const std::stop_token& stop);

}  // namespace elbowroom::recon
