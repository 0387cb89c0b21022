// How well a rig predicts what it wasn't made from.
#pragma once

#include <optional>
#include <stop_token>

#include "recon/calibration/rig_fit.h"

namespace elbowroom::recon {

struct HeldOutFigures {
  std::optional<double> rms_px;
  std::optional<double> cross_camera_rms_px;
  std::optional<double> rigidity_rms_mm;
};

// Every fifth set that several cameras confirm is kept out of a second fit. rms_px: error of its views, whose
// board is placed by all of them. cross_camera_rms_px: of each view, whose board is placed by the other
// cameras alone (by two of them at least, where the rig has more than two): the strictest figure, as nothing
// in that view was fitted. rigidity_rms_mm: error of the distances between points of the board that two or
// more cameras triangulate, from each to the farthest. Motion between the instants of a set is taken off the
// pixels first. Nothing where there are fewer than six such sets. Throws: Error{kCancelled}.
[[nodiscard]] HeldOutFigures MeasureHeldOut(const RigFit& fit, const std::stop_token& stop);

}  // namespace elbowroom::recon
