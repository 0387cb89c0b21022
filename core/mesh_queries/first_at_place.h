// Vertices of a mesh that lie at one place.
#pragma once

#include <cstdint>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::core {

// For each vertex the first one at its place, which may be itself: the same for all that are equal to the
// last bit, as files have them that give each face vertices of its own. Thread: any.
[[nodiscard]] std::vector<std::int32_t> FirstAtPlace(const TriangleMesh& mesh);

}  // namespace elbowroom::core
