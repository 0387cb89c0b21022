// Where a surface runs through itself.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

struct SelfIntersections {
  std::int64_t pairs = 0;                // of triangles that meet elsewhere than in the corners they share
  std::vector<std::uint32_t> triangles;  // of these pairs, ascending, each once
};

// Pairs of triangles that cross, lie on each other or touch elsewhere than in a corner or edge that both
// have. Two with the same three corners, the sides of a sheet, aren't counted, nor are triangles without
// area. The mesh must be welded. Exact: candidates are found by their boxes, and each is decided by CGAL's
// exact predicates. Held to a test of all pairs in rational numbers by self_intersections_test. Throws:
// Error{kCancelled}. Thread: any.
[[nodiscard]] SelfIntersections FindSelfIntersections(const core::TriangleMesh& mesh,
                                                      const std::stop_token& stop = {});

}  // namespace elbowroom::cad_import
