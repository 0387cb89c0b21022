// The paper's block-design task, scripted: a hand takes wooden blocks one by one, turns each, and sets them
// side by side to a square pattern.
#pragma once

#include <vector>

#include "recon/synthetic/actors.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

inline constexpr double kBlockMm = 76.2;  // the paper's: 3 inches

// How a person does it.
struct BlockManner {
  HandBuild hand;
  double from_rad = 0.0;  // where the person stands, about the z axis from the x axis
  double lift_mm = 0.0;   // higher than need be: blocks that are carried; [0, 150]
};

// The hand and all blocks at a share of the pattern's time, 0 to 1. `side`: blocks on a side of the pattern,
// 2 or 3. It begins and ends without the hand near. World: the pattern about the z axis, the table top z = 0.
// Throws: PreconditionError.
[[nodiscard]] std::vector<SyntheticObject> BlocksAt(const BlockManner& manner, int side, double share);

// The share of the time at which the last block stands in its place.
[[nodiscard]] double PatternDoneAt(int side);

}  // namespace elbowroom::recon
