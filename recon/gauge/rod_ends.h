// The free ends of a rod in a camera's picture.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "recon/gauge/straight_strips.h"

namespace elbowroom::recon {

struct SeenEnd {
  Eigen::Vector2d position;  // of the tip, on the strip's middle line
  double step = 1.0;         // what a pixel is along the strip, plane units
};

// The end at which the contour goes from the one side around to the other; `is_forward`: in the strip's
// direction. Nothing where it goes elsewhere, as along a hand or the picture's border.
[[nodiscard]] std::optional<SeenEnd> FreeEnd(const RodView& view, const Strip& strip, bool is_forward);

}  // namespace elbowroom::recon
