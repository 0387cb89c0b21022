// Which distortion model a camera's lens has, judged by the views that agree with the rig.
#pragma once

#include <stop_token>

#include "recon/calibration/adjustment.h"

namespace elbowroom::recon {

// The lens of the model that the camera's used views tell: the simplest whose error on points left out (five
// folds, each view with a board pose of its own) no other's is clearly below, by two standard errors of the
// views' differences. A fisheye must be better by 9 of chi squared, too: it has no tangential terms, and puts
// those of a lens that has them into the principal point. It isn't tried where a plumb_bob is enough. If the
// present model is the best, the present lens, unchanged. Throws: Error{kCancelled}.
[[nodiscard]] LensParameters ChooseLens(const Adjustment& rig, int camera, double noise_scale,
                                        const std::stop_token& stop);

}  // namespace elbowroom::recon
