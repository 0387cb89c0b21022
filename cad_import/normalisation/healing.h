// From the triangle soup that files hold to indexed meshes whose surface can be judged.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// A mesh, with the number of the owner (a piece of the file) of each triangle.
struct OwnedMesh {
  core::TriangleMesh mesh;
  std::vector<std::uint32_t> owner_of_triangle;
};

// First, coordinates that are rounding noise beside the mesh's size become 0: modellers write 3e-17 for 0 in
// one triangle and 0 in the next. Then bit-equal vertices become one, in the order of their first use;
// vertices without a triangle are dropped, and so are triangles with two equal corners. Every vertex must be
// finite and every index in range.
void Weld(OwnedMesh& body);

// In this order: drops copies of triangles that face the same way; drops triangles without area, unless all
// edges are sound by then, because a closed surface hangs together by them; makes neighbours run alike,
// turning the fewer; turns closed surfaces that face inwards, unless they are cavities of others. Counts what
// it did and what is left. The body must be welded; owners stay ascending.
[[nodiscard]] SurfaceReport Heal(OwnedMesh& body);

}  // namespace elbowroom::cad_import
