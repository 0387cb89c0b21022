// A hull whose faces are known.
#pragma once

#include "recon/hull/visual_hull.h"

namespace elbowroom::review {

// The hull as three far cameras of 1 px a millimetre make it: the box [-50, 50]^3 to a ten-thousandth, or
// nothing.
[[nodiscard]] recon::VisualHull BoxHull(bool is_empty = false);
// What the same cameras make of pictures that are object all over: their workspace, [-95, 95]^3.
[[nodiscard]] recon::VisualHull FullHull();
inline constexpr double kBoxHullMm = 0.01;  // how far its faces are from +-50: 100 mm of depth in 1e6

}  // namespace elbowroom::review
