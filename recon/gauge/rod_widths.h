// A rod's diameter, and where each camera sees it, from the sights of all cameras.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "recon/gauge/rod_errors.h"
#include "recon/gauge/rod_gauge.h"
#include "recon/gauge/rod_sights.h"

namespace elbowroom::recon {

struct CameraWidth {
  BoundedMm diameter;
  double excess_px = 0.0;
  bool is_hard = false;  // a ready mask's: the silhouettes' share is certain
};

// By the picture of one camera alone, which has both sides. Nothing: too few points.
[[nodiscard]] std::optional<CameraWidth> WidthIn(const FittedRod& rod, int camera, const RodErrors& errors,
                                                 const BoundaryLimits& limits);

struct CombinedWidth {
  BoundedMm diameter;
  bool agree = true;
};

// Certain ranges are intersected; others are averaged, and their bounds too. `widths` isn't empty.
[[nodiscard]] CombinedWidth Combined(std::span<const CameraWidth> widths);

// How far beside the axis that the others see this camera sees it; nothing if they don't tell the axis.
[[nodiscard]] std::optional<BoundedMm> OffsetOf(const FittedRod& rod, int camera, const RodErrors& errors);

}  // namespace elbowroom::recon
