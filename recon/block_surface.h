// The hull's surface in one cube of an octree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "recon/hull_blocks.h"
#include "recon/visual_hull.h"

namespace elbowroom::recon {

struct BlockSurface {
  std::vector<Eigen::Vector3d> vertices_in_world;
  // By vertex: the grid edge that it stands on (EdgeKey) if other blocks have that edge too; else 0.
  std::vector<std::uint64_t> shared_edges;
  std::vector<std::array<std::int32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::int64_t cells = 0;                              // looked at
  std::int64_t queries = 0;  // labels and crossings asked, of all cameras of the block
};

// Never 0. `low`: the end of the grid edge with the smaller coordinate along `axis`.
[[nodiscard]] std::uint64_t EdgeKey(const GridPoint& low, int axis);

// Marching cubes over the block's mixed cells. A vertex stands where its grid edge first leaves the hull,
// counted from the end that is inside: on the exact surface, but at least edge / 2048 from the ends.
[[nodiscard]] BlockSurface CutBlock(const VisualHull& hull, const HullGrid& grid, const HullBlock& block);

}  // namespace elbowroom::recon
