// The lens of one camera, from its own views of a board.
#pragma once

#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "recon/calibration/adjustment.h"
#include "recon/calibration/calibration_input.h"

namespace elbowroom::recon {

// A view's points as the adjustment has them.
[[nodiscard]] std::vector<AdjustedPoint> AdjustedPointsOf(const BoardSighting& sighting);

struct LensFit {
  LensParameters lens;
  double rms_px = 0.0;
  int views = 0;  // that agree with the lens
};

// The least number of views that show a lens.
inline constexpr int kLeastLensViews = 3;

// Focal length from a row of candidates, then a fit with the views' poses; views and points that don't agree
// are left out. Where the model isn't given, it is a rough choice: the simplest with which about as many
// points agree as with any (lens_choice.h judges it by the rig). Throws: Error{kCamera} naming the camera if
// fewer than three views agree; Error{kCancelled}.
[[nodiscard]] LensFit FitLens(const CalibrationCamera& camera, const BoardSurface& surface,
                              std::span<const CalibrationView* const> views, const std::stop_token& stop);

}  // namespace elbowroom::recon
