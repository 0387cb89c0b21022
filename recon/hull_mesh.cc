#include "recon/hull_mesh.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "recon/block_surface.h"
#include "recon/hull_blocks.h"

namespace elbowroom::recon {
namespace {

// Numbers for the grid edges that several blocks have: an open-addressing table, as a general one would take
// a third of the mesh's time.
class SharedEdges {
 public:
  explicit SharedEdges(std::size_t most)
      : slots_(std::bit_ceil(2 * most + 1), {0, 0}), shift_(64 - std::countr_zero(slots_.size())) {}

  // The edge's number: `number` if it has none yet.
  std::int32_t NumberOf(std::uint64_t edge, std::int32_t number) {
    // Fibonacci hashing.
    std::size_t i = slots_.size() > 1 ? (edge * 0x9E3779B97F4A7C15U) >> static_cast<unsigned>(shift_) : 0;
    while (slots_[i].first != 0 && slots_[i].first != edge) i = (i + 1) & (slots_.size() - 1);
    if (slots_[i].first == 0) slots_[i] = {edge, number};
    return slots_[i].second;
  }

 private:
  std::vector<std::pair<std::uint64_t, std::int32_t>> slots_;
  int shift_;
};

// By block and vertex: its number in the mesh. A vertex that several blocks have is the first one's.
std::vector<std::vector<std::int32_t>> NumberVertices(std::span<const BlockSurface> surfaces,
                                                      std::size_t* count) {
  std::size_t shared = 0;
  for (const BlockSurface& surface : surfaces) shared += surface.shared_edges.size();
  SharedEdges edges(shared);
  std::vector<std::vector<std::int32_t>> numbers(surfaces.size());
  std::int32_t next = 0;
  for (std::size_t block = 0; block < surfaces.size(); ++block) {
    for (const std::uint64_t edge : surfaces[block].shared_edges) {
      const std::int32_t number = edge == 0 ? next : edges.NumberOf(edge, next);
      numbers[block].push_back(number);
      if (number == next) ++next;
    }
  }
  *count = static_cast<std::size_t>(next);
  return numbers;
}

core::TriangleMesh Join(std::span<const BlockSurface> surfaces) {
  std::size_t vertices = 0;
  const std::vector<std::vector<std::int32_t>> numbers = NumberVertices(surfaces, &vertices);
  std::vector<std::size_t> first(surfaces.size() + 1, 0);
  for (std::size_t block = 0; block < surfaces.size(); ++block)
    first[block + 1] = first[block] + surfaces[block].triangles.size();
  core::TriangleMesh mesh;
  mesh.vertices_mm.resize(vertices);
  mesh.triangles.resize(first.back());
  // A shared vertex is at the same place in each of its blocks, to the last bit; the first one's is written.
  std::int32_t next = 0;
  for (std::size_t block = 0; block < surfaces.size(); ++block) {
    for (std::size_t i = 0; i < numbers[block].size(); ++i) {
      if (numbers[block][i] != next) continue;
      mesh.vertices_mm[static_cast<std::size_t>(next++)] = surfaces[block].vertices_in_world[i];
    }
  }
  tbb::parallel_for(std::size_t{0}, surfaces.size(), [&](std::size_t block) {
    const auto number = [&](std::int32_t vertex) { return numbers[block][static_cast<std::size_t>(vertex)]; };
    for (std::size_t i = 0; i < surfaces[block].triangles.size(); ++i) {
      const std::array<std::int32_t, 3>& triangle = surfaces[block].triangles[i];
      mesh.triangles[first[block] + i] = {number(triangle[0]), number(triangle[1]), number(triangle[2])};
    }
  });
  return mesh;
}

}  // namespace

HullMesh MeshHull(const VisualHull& hull, double edge_mm, const core::Progress& progress,
                  std::stop_token stop) {
  const HullGrid grid = MakeHullGrid(hull.rig().workspace_mm, edge_mm);
  HullMesh result;
  result.skipped_cells = grid.cells.cast<std::int64_t>().prod();
  if (hull.IsEmpty()) return result;
  const HullBlocks found = FindHullBlocks(hull, grid, progress, stop);
  std::vector<BlockSurface> surfaces(found.blocks.size());
  tbb::parallel_for(std::size_t{0}, surfaces.size(), [&](std::size_t i) {
    if (!stop.stop_requested()) surfaces[i] = CutBlock(hull, grid, found.blocks[i]);
  });
  core::ThrowIfStopped(stop, "meshing the hull");
  result.queries = found.queries;
  for (const BlockSurface& surface : surfaces) {
    result.cells += surface.cells;
    result.queries += surface.queries;
  }
  result.skipped_cells -= result.cells;
  result.mesh = Join(surfaces);
  return result;
}

}  // namespace elbowroom::recon
