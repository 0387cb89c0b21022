// The hull's surface as a closed triangle mesh.
#pragma once

#include <cstdint>
#include <stop_token>

#include "core/progress.h"
#include "core/triangle_mesh.h"
#include "recon/visual_hull.h"

namespace elbowroom::recon {

struct HullMesh {
  core::TriangleMesh mesh;   // world, mm; watertight and 2-manifold by construction; empty hull: no triangles
  std::int64_t cells = 0;    // finest cells that the surface may cross
  std::int64_t queries = 0;  // ball and point queries asked
  std::int64_t skipped_cells = 0;  // finest cells settled with a larger one by a ball query
};

// An octree over the workspace is refined where the ball query says mixed, down to cubes of `edge_mm`; their
// six tetrahedra are cut where the hull's surface crosses an edge, each vertex within edge_mm / 1000 of it.
// Six tetrahedra a cube leave no ambiguous case, so the surface is a closed 2-manifold; a workspace face that
// cuts the hull becomes a cap. Features thinner than edge_mm may be lost. Throws: core::Error{kRange} when
// edge_mm isn't positive or the grid would exceed 2^20 cells a side; core::Error{kCancelled}. Thread: any;
// the result doesn't depend on the number of threads.
[[nodiscard]] HullMesh MeshHull(const VisualHull& hull, double edge_mm, const core::Progress& progress = {},
                                std::stop_token stop = {});

}  // namespace elbowroom::recon
