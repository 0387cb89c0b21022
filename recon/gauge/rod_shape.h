// How straight and how long a rod is, by the silhouettes of all cameras.
#pragma once

#include <optional>
#include <span>

#include "recon/gauge/rod_errors.h"
#include "recon/gauge/rod_gauge.h"
#include "recon/gauge/rod_search.h"
#include "recon/gauge/rod_sights.h"

namespace elbowroom::recon {

// The largest distance of the axis, as a parabola, from the straight line through its ends. Nothing: the
// cameras don't tell it.
[[nodiscard]] std::optional<BoundedMm> StraightnessOf(const FittedRod& rod, const RodErrors& errors);

// Between the rod's two ends, whatever their shape between a flat cut and a half ball. Nothing: no camera
// sees a free end on either side.
[[nodiscard]] std::optional<BoundedMm> LengthOf(const FittedRod& rod, std::span<const RodView> views,
                                                std::span<const RodStrip> strips, const RodErrors& errors,
                                                const BoundaryLimits& limits);

}  // namespace elbowroom::recon
