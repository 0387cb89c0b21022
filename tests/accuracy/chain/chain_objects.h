// What is real in the simulated chain: hands and tools that move before the cameras.
#pragma once

#include <cstdint>
#include <vector>

#include "recon/synthetic/solids.h"
#include "tests/recon/consistency/moving_hands.h"

namespace elbowroom::accuracy {

enum class ChainObject { kOpenHand, kFist, kTongs, kPipe, kBall, kCable };
inline constexpr ChainObject kChainObjects[] = {ChainObject::kOpenHand, ChainObject::kFist,
                                                ChainObject::kTongs,    ChainObject::kPipe,
                                                ChainObject::kBall,     ChainObject::kCable};

struct ChainMotion {
  ChainObject object = ChainObject::kOpenHand;
  recon::testing::HandMotion motion;
};

// Reach and speed of a hand at work around a middle. The same for the same seed.
[[nodiscard]] ChainMotion DrawChainMotion(ChainObject object, const Eigen::Vector3d& middle_in_world,
                                          std::uint64_t seed);

// What stands there at a time, in world.
[[nodiscard]] std::vector<recon::Solid> SolidsAt(const ChainMotion& motion, double time_s);

}  // namespace elbowroom::accuracy
