#include "recon/block_surface.h"

#include <bit>
#include <cstddef>

#include "core/error.h"
#include "recon/cube_table.h"

namespace elbowroom::recon {
namespace {

constexpr auto kSide = static_cast<std::size_t>(kBlockPoints);
constexpr unsigned kRowOfCells = (1U << kBlockCells) - 1U;

using Rows = std::array<std::array<unsigned, kSide>, kSide>;  // of labels, by z and y

Rows RowsOf(const BlockBits& labels) {
  Rows rows;
  for (int z = 0; z < kBlockPoints; ++z)
    for (int y = 0; y < kBlockPoints; ++y)
      rows[static_cast<std::size_t>(z)][static_cast<std::size_t>(y)] = labels.Row(y, z);
  return rows;
}

// Calls visit(x, y, z, corners inside) for the cells that the surface cuts.
template <typename Visit>
void VisitCutCells(const Rows& rows, const Visit& visit) {
  for (std::size_t z = 0; z + 1 < kSide; ++z) {
    for (std::size_t y = 0; y + 1 < kSide; ++y) {
      const unsigned a = rows[z][y], b = rows[z][y + 1], c = rows[z + 1][y], d = rows[z + 1][y + 1];
      const unsigned any = a | b | c | d, all = a & b & c & d;
      unsigned cut = (any | any >> 1U) & ~(all & all >> 1U) & kRowOfCells;
      for (; cut != 0; cut &= cut - 1) {
        const auto x = static_cast<unsigned>(std::countr_zero(cut));
        const unsigned inside =
            (a >> x & 3U) | (b >> x & 3U) << 2U | (c >> x & 3U) << 4U | (d >> x & 3U) << 6U;
        visit(x, y, z, inside);
      }
    }
  }
}

// Calls visit(axis, x, y, z, whether the edge's lower end is inside) for the block's own edges that change.
template <typename Visit>
void VisitChanges(const Rows& rows, const Visit& visit) {
  for (std::size_t z = 0; z + 1 < kSide; ++z) {
    for (std::size_t y = 0; y + 1 < kSide; ++y) {
      const unsigned row = rows[z][y];
      const std::array<unsigned, 3> next = {row >> 1U, rows[z][y + 1], rows[z + 1][y]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (unsigned changes = (row ^ next[axis]) & kRowOfCells; changes != 0; changes &= changes - 1) {
          const auto x = static_cast<unsigned>(std::countr_zero(changes));
          visit(axis, x, y, z, (row >> x & 1U) != 0);
        }
      }
    }
  }
}

constexpr std::size_t Index(std::size_t axis, std::size_t x, std::size_t y, std::size_t z) {
  return ((axis * kSide + z) * kSide + y) * kSide + x;
}

// By edge of a cube: how far from the index of the cell's corner, along axis 0.
constexpr std::array<std::size_t, kCubeEdges.size()> EdgeOffsets() {
  std::array<std::size_t, kCubeEdges.size()> offsets{};
  for (std::size_t edge = 0; edge < offsets.size(); ++edge) {
    const auto low = static_cast<std::size_t>(kCubeEdges[edge].low);
    offsets[edge] = Index(edge / 4, low & 1U, low >> 1U & 1U, low >> 2U);
  }
  return offsets;
}
constexpr auto kEdgeOffsets = EdgeOffsets();

// By Index(): a grid edge's vertex in the mesh, or -1.
using VertexNumbers = std::array<std::int32_t, Index(3, 0, 0, 0)>;

VertexNumbers NumberEdges(std::span<const BlockNeighbour> blocks) {
  VertexNumbers numbers;
  numbers.fill(-1);
  for (const BlockNeighbour& block : blocks) {
    const unsigned steps = block.steps;
    const std::size_t shift =
        Index(0, (steps & 1U) * kBlockCells, (steps >> 1U & 1U) * kBlockCells, (steps >> 2U) * kBlockCells);
    std::int32_t number = block.first_vertex;
    for (const BlockEdge& edge : block.surface->edges) {
      const auto [x, y, z] = edge.low;
      if ((steps & ~unsigned{edge.near_faces}) == 0) numbers[shift + Index(edge.axis, x, y, z)] = number;
      ++number;
    }
  }
  return numbers;
}

}  // namespace

BlockSurface CutBlock(const HullLattice& lattice, const HullBlock& block) {
  BlockSurface surface;
  surface.labels = lattice.LabelsOf(block, &surface.queries);
  const Rows rows = RowsOf(surface.labels);
  const std::array<CubeTriangles, 256>& table = CubeTable();
  VisitCutCells(rows, [&](std::size_t, std::size_t, std::size_t, unsigned inside) {
    surface.triangles += table[inside].count;
  });
  if (surface.triangles == 0) return surface;
  surface.edges.reserve(surface.triangles);  // about half of them, and those that cells before don't have
  VisitChanges(rows, [&](std::size_t axis, std::size_t x, std::size_t y, std::size_t z, bool low_is_inside) {
    const auto byte = [](std::size_t number) { return static_cast<std::uint8_t>(number); };
    const unsigned near_faces = unsigned{x == 0} | unsigned{y == 0} << 1U | unsigned{z == 0} << 2U;
    surface.edges.push_back({byte(axis), {byte(x), byte(y), byte(z)}, low_is_inside, byte(near_faces)});
  });
  surface.vertices_in_world.resize(surface.edges.size());
  lattice.FindExits(block, surface.edges, surface.vertices_in_world);
  surface.queries += static_cast<std::int64_t>(surface.edges.size());
  return surface;
}

void WriteTriangles(std::span<const BlockNeighbour> blocks,
                    std::span<std::array<std::int32_t, 3>> triangles) {
  const VertexNumbers numbers = NumberEdges(blocks);
  const std::array<CubeTriangles, 256>& table = CubeTable();
  std::size_t next = 0;
  std::int32_t least = 0;
  VisitCutCells(RowsOf(blocks.front().surface->labels),
                [&](std::size_t x, std::size_t y, std::size_t z, unsigned inside) {
                  const std::int32_t* const cell = numbers.data() + Index(0, x, y, z);
                  const CubeTriangles& cut = table[inside];
                  for (std::size_t i = 0; i < cut.count; ++i) {
                    std::array<std::int32_t, 3>& triangle = triangles[next++];
                    for (std::size_t corner = 0; corner < 3; ++corner) {
                      triangle[corner] = cell[kEdgeOffsets[cut.all[i][corner]]];
                      least = std::min(least, triangle[corner]);
                    }
                  }
                });
  core::Require(least >= 0, "the surface goes on in the next blocks");
}

}  // namespace elbowroom::recon
