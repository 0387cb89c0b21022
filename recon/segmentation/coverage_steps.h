// Which pixels a boundary pixel is compared with, by the labels around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace elbowroom::recon {

// The direction from background to object is that of the first moments of the labels of 5 x 5 pixels, each
// from -kMostMoment to kMostMoment.
inline constexpr int kMostMoment = 15;
inline constexpr int kMoments = 2 * kMostMoment + 1;

// One to three pixels along a direction, rounded to pixels, packed: dx and dy of the first step in four bits
// each, two's complement, from the lowest bit on; then the second and the third step, then the flags. No
// step is zero, except where there is no direction: then all are, and only kIsAlongX is set.
using PackedSteps = std::uint32_t;
inline constexpr int kStepBits = 4;
inline constexpr PackedSteps kIsAlongX = 1U << 24U;  // across the boundary is nearer to x than to y
inline constexpr PackedSteps kHasDirection = 1U << 25U;

// By moments: index (y + kMostMoment) * kMoments + x + kMostMoment.
using StepTable = std::array<PackedSteps, static_cast<std::size_t>(kMoments* kMoments)>;
[[nodiscard]] const StepTable& AllSteps();

}  // namespace elbowroom::recon
