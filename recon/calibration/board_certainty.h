// Which boards' poses are confirmed.
#pragma once

#include <vector>

#include "recon/calibration/adjustment.h"

namespace elbowroom::recon {

// For each board, how well its turn is known without the one view of its set that tells most of it [rad],
// with the cameras as they are. Of a board that one view alone shows at its instant, or that stands between
// the instants of all pictures, it is large or infinite: nothing would show that the view is wrong.
[[nodiscard]] std::vector<double> ConfirmedTurnSigmas(const Adjustment& adjustment, double noise_scale);

}  // namespace elbowroom::recon
