// From the triangle soup that files hold to indexed meshes whose surface can be judged.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// A mesh, and of which of some owners (pieces of a file) each triangle is.
struct OwnedMesh {
  core::TriangleMesh mesh;
  std::vector<std::uint32_t> owner_of_triangle;
};

// Bit-equal vertices become one, in the order of their first use; unused ones go, and so do triangles with
// two equal corners. Coordinates that are rounding noise beside the mesh's size are 0 first: modellers write
// 3e-17 for 0 in one triangle and 0 in the next. Every vertex is finite, every index in range.
void Weld(OwnedMesh& body);

// In this order: drops triangles without area (but those of three different corners that a closed surface
// hangs together by) and copies of others that face the same way; makes neighbours run alike, turning the
// fewer; turns closed surfaces that face inwards, unless they are cavities of others. Counts what it did and
// what is left. The body is welded; owners stay ascending.
[[nodiscard]] SurfaceReport Heal(OwnedMesh& body);

}  // namespace elbowroom::cad_import
