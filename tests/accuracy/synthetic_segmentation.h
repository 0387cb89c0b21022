// Pictures of solids with sensor noise, segmented as the program does it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "tests/oracles/analytic_hull.h"

namespace elbowroom::accuracy {

// Renders what each sight's camera (of `rig`: the true one) saw, each pixel on an edge the mixture of
// kRaysPerPixelSide x kRaysPerPixelSide rays, as a sensor mixes what falls on it, with Gaussian noise on
// every pixel and channel; and segments it with the default options, boundaries located between pixels,
// against a background of kBackgroundFrames frames of the same noise.
inline constexpr int kBackgroundFrames = 30;
inline constexpr int kRaysPerPixelSide = 8;
[[nodiscard]] std::vector<core::SoftMask> SegmentSights(const core::Rig& rig,
                                                        std::span<const oracles::Sight> sights,
                                                        double noise_levels, std::uint64_t seed);

}  // namespace elbowroom::accuracy
