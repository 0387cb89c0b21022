// The hull's surface in one block of an octree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "recon/hull_mesh/hull_lattice.h"

namespace elbowroom::recon {

// The part of the surface that belongs to a block: the vertices on grid edges that start within it or on its
// near faces, and the triangles in its cells, whose corners may be vertices of the next blocks.
struct BlockSurface {
  BlockBits labels;
  std::vector<BlockEdge> edges;                    // that the surface crosses; first those on near faces
  std::size_t near_edges = 0;                      // the number of those
  std::vector<Eigen::Vector3d> vertices_in_world;  // one an edge
  std::size_t triangles = 0;
  std::int64_t queries = 0;  // labels and crossings asked
};

// Marching cubes over the block's cells. A vertex stands where its grid edge first leaves the hull, counted
// from the end that is inside: on the exact surface, but at least edge / 2048 from the ends.
[[nodiscard]] BlockSurface CutBlock(const HullLattice& lattice, const HullBlock& block);

// A block that a block's triangles have vertices of: itself, or one of those next to it.
struct BlockNeighbour {
  unsigned steps = 0;  // bit a: it is the next one along axis a; 0: the block itself
  const BlockSurface* surface = nullptr;
  std::int32_t first_vertex = 0;  // the number of its first vertex in the whole mesh
};

// For each grid edge of a block the number of its vertex in the whole mesh. Working memory of WriteTriangles.
class VertexNumbers {
 public:
  static constexpr std::int32_t kNone = -1;
  static constexpr std::size_t kEdges = 3UL * kBlockPoints * kBlockPoints * kBlockPoints;

 private:
  friend void WriteTriangles(std::span<const BlockNeighbour> blocks,
                             std::span<std::array<std::int32_t, 3>> triangles, VertexNumbers* numbers);
  std::array<std::int32_t, kEdges> numbers_;
};

// Writes the triangles of a block, counter-clockwise seen from outside, from its own surface, which comes
// first, and those of the blocks behind it along the axes. Throws: PreconditionError when one is missing;
// then `numbers` can't be used again.
void WriteTriangles(std::span<const BlockNeighbour> blocks, std::span<std::array<std::int32_t, 3>> triangles,
                    VertexNumbers* numbers);

}  // namespace elbowroom::recon
