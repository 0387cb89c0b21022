// How the triangles of a mesh hang together along their edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// One side of a triangle.
struct EdgeUse {
  std::int32_t low = 0;  // vertices, low < high
  std::int32_t high = 0;
  std::uint32_t triangle = 0;
  bool is_upward = false;  // the triangle runs along it from low to high
};

// All sides, those of one edge consecutive. No triangle may have two equal corners.
[[nodiscard]] std::vector<EdgeUse> SortedEdgeUses(const core::TriangleMesh& mesh);

// Calls `visit` with the uses of each edge, a span.
void ForEachEdge(std::span<const EdgeUse> sorted, auto visit) {
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin + 1;
    while (end < sorted.size() && sorted[begin].low == sorted[end].low &&
           sorted[begin].high == sorted[end].high)
      ++end;
    visit(sorted.subspan(begin, end - begin));
    begin = end;
  }
}

enum class EdgeKind {
  kSound,         // of two triangles that run along it opposite ways
  kOpen,          // of one
  kNonManifold,   // of three or more
  kInconsistent,  // of two that run along it the same way
};
[[nodiscard]] EdgeKind KindOf(std::span<const EdgeUse> edge);

struct EdgeCounts {
  std::int64_t open = 0, non_manifold = 0, inconsistent = 0;
  [[nodiscard]] bool are_closed() const { return open == 0 && non_manifold == 0 && inconsistent == 0; }
};
[[nodiscard]] EdgeCounts CountEdges(std::span<const EdgeUse> sorted);

// Triangles that hang together over edges of exactly two.
struct Patch {
  std::vector<std::uint32_t> triangles;  // ascending
  std::vector<std::uint32_t> odd;        // those of them to turn so that all run alike; at most half
  bool is_orientable = true;             // else nothing is odd
  bool is_closed = true;                 // all their edges are of exactly two
};
// Sorted by their first triangles.
[[nodiscard]] std::vector<Patch> FindPatches(const core::TriangleMesh& mesh, std::span<const EdgeUse> sorted);

// For each triangle the number of the piece it belongs to, connected over shared vertices, in order of
// appearance.
[[nodiscard]] std::vector<std::size_t> PieceOfTriangle(const core::TriangleMesh& mesh);

}  // namespace elbowroom::cad_import
