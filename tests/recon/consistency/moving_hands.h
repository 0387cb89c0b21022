// Hands and other things that move smoothly before a simulated rig, as spheres and capsules.
#pragma once

#include <cstdint>
#include <vector>

#include "core/rig.h"
#include "recon/synthetic/solids.h"

namespace elbowroom::recon::testing {

enum class MovingShape { kOpenHand, kFist, kTwoHands, kTongs, kBumpyBall };
inline constexpr MovingShape kMovingShapes[] = {MovingShape::kOpenHand, MovingShape::kFist,
                                                MovingShape::kTwoHands, MovingShape::kTongs,
                                                MovingShape::kBumpyBall};
[[nodiscard]] const char* NameOf(MovingShape shape);

struct HandMotion {
  MovingShape shape = MovingShape::kOpenHand;
  std::uint64_t seed = 1;
  double speed = 1.0;         // factor on all frequencies: 1 is a hand at work, about 250 mm/s
  double reach_mm = 90.0;     // how far it goes from the middle, along each axis
  double forearm_mm = 120.0;  // elbow behind the wrist
  Eigen::Vector3d middle_in_world{60.0, 0.0, 200.0};
};

// The pose of the first hand's wrist, of the tongs or of the ball at a time.
[[nodiscard]] core::RigidTransform PoseAt(const HandMotion& motion, double time_s);

// What stands there at a time. A sum of sines with seeded phases: smooth, never at rest, never the same.
[[nodiscard]] std::vector<Solid> HandsAt(const HandMotion& motion, double time_s);

// `count` cameras of 640 x 480, 50 degrees wide, 1.2 m around the middle at heights in turn, with the mild
// distortion of FourCameraRig (3 or more).
[[nodiscard]] core::Rig HandRig(int count);

}  // namespace elbowroom::recon::testing
