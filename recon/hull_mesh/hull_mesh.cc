#include "recon/hull_mesh/hull_mesh.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "recon/hull/visual_hull.h"
#include "recon/hull_mesh/block_surface.h"
#include "recon/hull_mesh/hull_blocks.h"

namespace elbowroom::recon {
namespace {

// How many vertices and triangles come before each block's; one more at the end.
struct Firsts {
  std::vector<std::size_t> vertices{0};
  std::vector<std::size_t> triangles{0};
};

Firsts CountUp(std::span<const BlockSurface> surfaces) {
  Firsts firsts;
  for (const BlockSurface& surface : surfaces) {
    firsts.vertices.push_back(firsts.vertices.back() + surface.vertices_in_world.size());
    firsts.triangles.push_back(firsts.triangles.back() + surface.triangles);
  }
  return firsts;
}

core::TriangleMesh Join(std::span<const HullBlock> blocks, std::span<const BlockSurface> surfaces) {
  const Firsts firsts = CountUp(surfaces);
  core::TriangleMesh mesh;
  mesh.vertices_mm.resize(firsts.vertices.back());
  mesh.triangles.resize(firsts.triangles.back());
  std::vector<std::uint64_t> keys(blocks.size());
  std::transform(blocks.begin(), blocks.end(), keys.begin(),
                 [](const HullBlock& block) { return MortonKey(block.corner); });
  tbb::enumerable_thread_specific<VertexNumbers> numbers;
  tbb::parallel_for(std::size_t{0}, surfaces.size(), [&](std::size_t i) {
    std::ranges::copy(surfaces[i].vertices_in_world,
                      mesh.vertices_mm.begin() + static_cast<std::ptrdiff_t>(firsts.vertices[i]));
    if (surfaces[i].triangles == 0) return;
    std::array<BlockNeighbour, 8> around;
    std::size_t count = 0;
    for (unsigned steps = 0; steps < 8; ++steps) {
      const GridPoint offset(steps & 1U, steps >> 1U & 1U, steps >> 2U);
      const std::uint64_t key = MortonKey(blocks[i].corner + offset * kBlockCells);
      const auto found = std::lower_bound(keys.begin() + static_cast<std::ptrdiff_t>(i), keys.end(), key);
      if (found == keys.end() || *found != key) continue;
      const auto block = static_cast<std::size_t>(found - keys.begin());
      around[count++] = {steps, &surfaces[block], static_cast<std::int32_t>(firsts.vertices[block])};
    }
    WriteTriangles({around.data(), count},
                   std::span(mesh.triangles).subspan(firsts.triangles[i], surfaces[i].triangles),
                   &numbers.local());
  });
  return mesh;
}

std::int64_t CellsOf(const HullGrid& grid, const HullBlock& block) {
  return (grid.cells - block.corner).cwiseMin(kBlockCells).cast<std::int64_t>().prod();
}

}  // namespace

HullMesh MeshHull(const VisualHull& hull, double edge_mm, const core::Progress& progress,
                  std::stop_token stop) {
  const HullGrid grid = MakeHullGrid(hull.rig().workspace_mm, edge_mm);
  HullMesh result;
  result.skipped_cells = grid.cells.cast<std::int64_t>().prod();
  if (hull.IsEmpty()) return result;
  const HullLattice lattice(hull, grid);
  const HullBlocks found = FindHullBlocks(hull, grid, progress, stop);
  std::vector<BlockSurface> surfaces(found.blocks.size());
  tbb::parallel_for(std::size_t{0}, surfaces.size(), [&](std::size_t i) {
    if (!stop.stop_requested()) surfaces[i] = CutBlock(lattice, found.blocks[i]);
  });
  core::ThrowIfStopped(stop, "meshing the hull");
  result.queries = found.queries;
  for (const BlockSurface& surface : surfaces) result.queries += surface.queries;
  for (const HullBlock& block : found.blocks) result.cells += CellsOf(grid, block);
  result.skipped_cells -= result.cells;
  result.mesh = Join(found.blocks, surfaces);
  return result;
}

}  // namespace elbowroom::recon
