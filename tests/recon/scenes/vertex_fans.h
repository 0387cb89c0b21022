// A mesh's fans: 2-manifold at its vertices, as core::IsWatertight is across its edges.
#pragma once

#include "core/triangle_mesh.h"

namespace elbowroom::recon {

// True if every vertex has one ring of triangles around it: none is unused, and none joins two rings that
// touch in a point.
[[nodiscard]] bool EveryVertexHasOneFan(const core::TriangleMesh& mesh);

}  // namespace elbowroom::recon
