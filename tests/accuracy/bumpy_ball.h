// A part of any number of triangles.
#pragma once

#include "core/triangle_mesh.h"

namespace elbowroom::accuracy {

// A ball of 100 mm with bumps of 5, as rings about its poles: 2 rings^2 triangles.
[[nodiscard]] core::TriangleMesh BumpyBall(int rings);

}  // namespace elbowroom::accuracy
