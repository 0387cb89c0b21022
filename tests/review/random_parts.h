// Parts of many kinds, and places for two of them: far, near, face to face, one in the other.
#pragma once

#include <random>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::review::testing {

enum class PartKind { kBox, kLumpyBall, kPrism, kSoup, kPanel, kNeedledBox };
inline constexpr int kPartKinds = 6;

// Some 10 to 40 mm large, around its origin. kBox, kLumpyBall and kPrism (whose caps are fans of thin
// triangles) are closed; kSoup, loose triangles, and kPanel, flat, are open; kNeedledBox has triangles
// without area on its edges and in its faces' middles.
[[nodiscard]] core::TriangleMesh MakePart(PartKind kind, std::mt19937_64& random);

struct PairOfPoses {
  core::RigidTransform world_from_a;
  core::RigidTransform world_from_b;
};

// Within about 60 mm of each other. Some are only quarter turns and whole millimetres apart (faces in one
// plane, exact touches), these also after one common turn, which rounds; some share their middle.
[[nodiscard]] PairOfPoses MakePoses(std::mt19937_64& random);

[[nodiscard]] core::RigidTransform AnyPose(std::mt19937_64& random, double reach_mm);

}  // namespace elbowroom::review::testing
