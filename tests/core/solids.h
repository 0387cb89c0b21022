// Closed solids with known volume and area.
#pragma once

#include "core/triangle_mesh.h"

namespace elbowroom::core::testing {

// Axis-aligned box from the origin to `size_mm`, 12 triangles, outwards.
[[nodiscard]] inline TriangleMesh Box(const Eigen::Vector3d& size_mm) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices_mm.emplace_back((i & 1) != 0 ? size_mm.x() : 0.0, (i & 2) != 0 ? size_mm.y() : 0.0,
                                  (i & 4) != 0 ? size_mm.z() : 0.0);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// The corner of a cube of that edge: volume edge^3 / 6.
[[nodiscard]] inline TriangleMesh CornerTetrahedron(double edge_mm) {
  return {{{0, 0, 0}, {edge_mm, 0, 0}, {0, edge_mm, 0}, {0, 0, edge_mm}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

}  // namespace elbowroom::core::testing
