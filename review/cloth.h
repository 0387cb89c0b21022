// A panel that hangs, swings, and gives way to the hull.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "recon/hull/visual_hull.h"
#include "review/cloth_panel.h"

namespace elbowroom::review {

// The solver's fixed step; a frame is cut into as many of these as fit, and one that fits the rest.
inline constexpr double kClothStepS = 1.0 / 960.0;
// The surface is looked at in pieces with no longer side; each is decided at its centre.
inline constexpr double kClothPieceMm = 8.0;
// So no point of the cloth is deeper in the hull than this: the farthest that a piece's corner can be from
// its centre (docs/deformables.md). Depth is the radius of a ball around the point all of which is in the
// hull.
inline constexpr double kClothDepthMm = kClothPieceMm * 2.0 / 3.0;
// No real thing moves through the cloth that is slower than this along V_rec.
inline constexpr double kFastestHandMmPerS = 2000.0;

// What a frame's step cost and left over.
struct ClothCount {
  std::int64_t queries = 0;    // of the hull
  std::int64_t contacts = 0;   // pieces and vertices moved out
  std::int64_t carried = 0;    // vertices and triangles that the hull had stepped over between two frames
  std::int64_t blocked = 0;    // pieces in the hull that pins hold there
  bool was_caught = false;     // it was about to tear, and let go: all of it left to one side, at rest
  double worst_stretch = 0.0;  // of an edge: |length / rest - 1|
  double mean_stretch = 0.0;
};

// Everything that the next step depends on: a value. Vectors have one entry a vertex unless said.
struct ClothState {
  std::vector<Eigen::Vector3d> x_in_world;
  std::vector<Eigen::Vector3d> velocity_in_world;  // mm/s
  std::vector<std::int8_t>
      sides;  // of those in touch: along (+1) or against V_rec they leave; 0: not in touch
  std::shared_ptr<const recon::VisualHull> hull;  // of the last step; null: none yet
  bool is_still = false;  // nothing moved in the last step, or touched: the next is skipped if nothing does
  ClothCount count;       // of the last step
};

[[nodiscard]] ClothState ClothAtRest(const ClothPanel& panel, const core::RigidTransform& world_from_part);

// The state `dt_s` later, the hull being the new frame's from the start: extended position-based dynamics,
// springs and contacts in turn (docs/deformables.md). Afterwards no point of the cloth is deeper in the hull
// than kClothDepthMm, but where pins hold it (count.blocked), and what moved slower than kFastestHandMmPerS
// has not passed through (cloth_test). Runs on the calling thread. Throws: PreconditionError for a state of
// another panel, a dt_s that isn't positive or is above 1 s. Thread: any.
[[nodiscard]] ClothState StepCloth(const ClothPanel& panel, ClothState state,
                                   const core::RigidTransform& world_from_part,
                                   const std::shared_ptr<const recon::VisualHull>& hull, double dt_s);

// The panel's triangles where the state has them, in world.
[[nodiscard]] core::TriangleMesh MeshInWorld(const ClothPanel& panel, const ClothState& state);

// The energy of motion and of height over z = 0, without that of the springs; uJ (mN mm).
[[nodiscard]] double EnergyUj(const ClothPanel& panel, const ClothState& state);

}  // namespace elbowroom::review
