// Which distortion model a camera's lens has, judged by the views that agree with the rig.
#pragma once

#include <stop_token>

#include "recon/calibration/adjustment.h"

namespace elbowroom::recon {

// The lens of the model that the camera's used views tell: the one with the least error on views left out
// (five folds), each view with a board pose of its own. A model without tangential terms (fisheye) must be
// clearly better, as it puts those of a lens that has them into the principal point. It isn't tried where a
// plumb_bob is enough. The present lens, unchanged, if its model is the best. Throws: Error{kCancelled}.
[[nodiscard]] LensParameters ChooseLens(const Adjustment& rig, int camera, double noise_scale,
                                        const std::stop_token& stop);

}  // namespace elbowroom::recon
