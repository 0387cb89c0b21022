// The hull's surface as a closed triangle mesh.
#pragma once

#include <cstdint>
#include <stop_token>

#include "core/progress.h"
#include "core/triangle_mesh.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

struct HullMesh {
  core::TriangleMesh mesh;   // world, mm; watertight and 2-manifold by construction; empty hull: no triangles
  std::int64_t cells = 0;    // finest cells whose corners were labelled: those of blocks that may be crossed
  std::int64_t queries = 0;  // balls, labels of points and crossings asked, of one camera each
  std::int64_t skipped_cells = 0;  // finest cells settled with a larger cube by ball queries: all the others
};

// An octree over the workspace is refined where the ball query says mixed, down to blocks of 8^3 cubes of
// `edge_mm`; these are marched, each vertex on the exact surface where its edge first leaves the hull (or
// edge / 2048 from the edge's end). The surface is a closed 2-manifold; a workspace face that cuts the hull
// becomes a face. Features thinner than edge_mm may be lost. Derivation in docs/algorithms.md. Throws:
// core::Error{kRange} when edge_mm isn't positive or the grid would have 2^20 cells a side or more;
// core::Error{kCancelled}. Thread: any; the result depends neither on the number of threads nor on the
// processor.
[[nodiscard]] HullMesh MeshHull(const VisualHull& hull, double edge_mm, const core::Progress& progress = {},
                                std::stop_token stop = {});

}  // namespace elbowroom::recon
