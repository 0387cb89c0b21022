// A panel that hangs, swings, and is pushed aside by the hull.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"
#include "recon/hull/visual_hull_declared.h"
#include "review/cloth_panel.h"

namespace elbowroom::review {

// The solver's longest step. A frame is cut into the fewest equal steps that are no longer.
inline constexpr double kClothStepS = 1.0 / 960.0;
// The surface is tested against the hull in pieces with no longer side, each at its centre.
inline constexpr double kClothPieceMm = 8.0;
// No point of the cloth stays deeper in the hull than this: a piece's centre is out of the hull, and no point
// of the piece is farther from it than two thirds of the longest side (docs/deformables.md). The depth of a
// point is the radius of the largest ball around it that is wholly in the hull.
inline constexpr double kClothDepthMm = kClothPieceMm * 2.0 / 3.0;
// An object that is no faster than this along V_rec pushes the cloth along and doesn't pass through it
// (limits: docs/deformables.md).
inline constexpr double kFastestHandMmPerS = 2000.0;

// The work and the outcome of a frame's step.
struct ClothCount {
  std::int64_t queries = 0;   // of the hull
  std::int64_t contacts = 0;  // moves of pieces out of the hull
  std::int64_t carried = 0;   // vertices and triangles' centres that the hull had passed between two frames
  std::int64_t blocked = 0;   // pieces that couldn't be moved out: pins hold them, or no way out was found
  bool was_caught = false;  // an edge became too long: the cloth was put at rest, all on one side of the hull
  double worst_stretch = 0.0;  // largest |length / rest - 1| of an edge
  double mean_stretch = 0.0;
};

// Everything that the next step depends on, as a value. Vectors have one entry a vertex.
struct ClothState {
  std::vector<Eigen::Vector3d> x_in_world;
  std::vector<Eigen::Vector3d> velocity_in_world;  // mm/s
  std::vector<std::int8_t>
      sides;  // whether a vertex in touch leaves along (+1) or against (-1) V_rec; 0: not in touch
  std::shared_ptr<const recon::VisualHull> hull;  // of the last step; null: none yet
  bool is_still = false;  // in the last step the cloth hardly moved and touched nothing: the next is skipped
                          // unless pins or hull move it
  ClothCount count;       // of the last step
};

[[nodiscard]] ClothState ClothAtRest(const ClothPanel& panel, const core::RigidTransform& world_from_part);

// The state `dt_s` later, by extended position-based dynamics: springs and contacts in turn
// (docs/deformables.md). The hull is the new frame's during the whole step. Afterwards no point of the cloth
// is deeper in the hull than kClothDepthMm, except where pins hold it (count.blocked), and an object slower
// than kFastestHandMmPerS has not passed through (cloth_test). Runs on the calling thread. Throws:
// PreconditionError for a state of another panel, no hull, or a dt_s that isn't within (0, 1] s. Thread: any.
[[nodiscard]] ClothState StepCloth(const ClothPanel& panel, ClothState state,
                                   const core::RigidTransform& world_from_part,
                                   const std::shared_ptr<const recon::VisualHull>& hull, double dt_s);

// The panel's mesh with the state's vertices, in world.
[[nodiscard]] core::TriangleMesh MeshInWorld(const ClothPanel& panel, const ClothState& state);

// Kinetic and gravitational energy (height over z = 0) of the free vertices, without that of the springs; in
// uJ (1 uJ = 1 mN mm).
[[nodiscard]] double EnergyUj(const ClothPanel& panel, const ClothState& state);

}  // namespace elbowroom::review
