// Two hands at the paper's other scenes: a curtain that they push aside, and a stream that they catch.
#pragma once

#include <vector>

#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

// World: as the demo's; the person sits towards +x. Both repeat, and begin and end without a hand.

// The curtain's plane is x = kCurtainXMm; both hands go through its middle and part.
inline constexpr double kCurtainXMm = 40.0;
inline constexpr double kCurtainSeconds = 10.0;
[[nodiscard]] std::vector<SyntheticObject> HandsAtCurtain(double time_s);

// Two cupped hands below the z axis.
inline constexpr double kFaucetSeconds = 12.0;
[[nodiscard]] std::vector<SyntheticObject> HandsAtFaucet(double time_s);

}  // namespace elbowroom::recon
