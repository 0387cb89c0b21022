#include "recon/hull_mesh/block_surface.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "recon/hull_mesh/cube_table.h"

namespace elbowroom::recon {
namespace {

constexpr auto kSide = static_cast<std::size_t>(kBlockPoints);
using Layer = std::uint64_t;  // 8 x 8 labels: bit x + 8 y
static_assert(kBlockCells == 8 && std::endian::native == std::endian::little);
constexpr Layer kFirstOfRows = 0x0101010101010101U, kFirstRow = 0xFFU;

// The labels of one z of a block: of its 8 x 8 near points, and a step on along x, along y, along both.
struct LayerLabels {
  Layer at, at_x, at_y, at_xy;
};

// Bit i to bit 8 i.
Layer SpreadToRows(unsigned byte) {
  // The multiples of seven bits don't overlap; the eighth bit is placed apart.
  return ((byte & 0x7FU) * Layer{0x0002040810204081U} & kFirstOfRows) | Layer{byte >> 7U & 1U} << 56U;
}

LayerLabels LabelsOf(const BlockBits& bits, std::size_t z) {
  LayerLabels labels;
  std::memcpy(&labels.at, &bits.groups[kSide * z], sizeof(Layer));
  std::memcpy(&labels.at_y, &bits.groups[kSide * z + 1], sizeof(Layer));
  // The nine bits of this z in the far face (x = 8).
  const std::size_t bit = kSide * z, group = BlockBits::kRows + bit / 8;
  const unsigned next = group + 1 < BlockBits::kGroups ? bits.groups[group + 1] : 0U;
  const unsigned far = (bits.groups[group] | next << 8U) >> (bit % 8);
  const auto step = [](Layer layer, unsigned beyond) {
    return (layer >> 1U & ~(kFirstOfRows << 7U)) | SpreadToRows(beyond & 0xFFU) << 7U;
  };
  labels.at_x = step(labels.at, far);
  labels.at_xy = step(labels.at_y, far >> 1U);
  return labels;
}

// Calls visit(x, y, z, corners inside) for the cells that the surface cuts.
template <typename Visit>
void VisitCutCells(const BlockBits& bits, const Visit& visit) {
  LayerLabels high = LabelsOf(bits, 0);
  for (std::size_t z = 0; z + 1 < kSide; ++z) {
    const LayerLabels low = std::exchange(high, LabelsOf(bits, z + 1));
    const Layer any = low.at | low.at_x | low.at_y | low.at_xy | high.at | high.at_x | high.at_y | high.at_xy;
    const Layer all = low.at & low.at_x & low.at_y & low.at_xy & high.at & high.at_x & high.at_y & high.at_xy;
    for (Layer cut = any & ~all; cut != 0; cut &= cut - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(cut));
      const auto four = [i](const LayerLabels& labels) {
        return (labels.at >> i & 1U) | (labels.at_x >> i & 1U) << 1U | (labels.at_y >> i & 1U) << 2U |
               (labels.at_xy >> i & 1U) << 3U;
      };
      visit(i % kBlockCells, i / kBlockCells, z, four(low) | four(high) << 4U);
    }
  }
}

// BlockEdge::index
constexpr std::size_t Index(std::size_t axis, std::size_t x, std::size_t y, std::size_t z) {
  return ((axis * kSide + z) * kSide + y) * kSide + x;
}

// The edges along axis 0 at z = 0, but for their label: item x + 8 y.
constexpr std::array<BlockEdge, 64> kEdgesOfLayer = [] {
  std::array<BlockEdge, 64> edges{};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::size_t x = i % kBlockCells, y = i / kBlockCells;
    edges[i].low = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0};
    edges[i].near_faces = static_cast<std::uint8_t>((x == 0 ? 1 : 0) | (y == 0 ? 2 : 0) | 4);
    edges[i].index = static_cast<std::uint16_t>(Index(0, x, y, 0));
  }
  return edges;
}();

// Appends the block's own edges that change: those on near faces, or all others.
void AppendChanges(const BlockBits& bits, bool on_near_faces, std::vector<BlockEdge>* edges) {
  LayerLabels high = LabelsOf(bits, 0);
  for (std::size_t z = 0; z + 1 < kSide; ++z) {
    const LayerLabels low = std::exchange(high, LabelsOf(bits, z + 1));
    const Layer on_faces = z == 0 ? ~Layer{0} : kFirstOfRows | kFirstRow;
    const std::array<Layer, 3> next = {low.at_x, low.at_y, high.at};
    for (std::uint8_t axis = 0; axis < 3; ++axis) {
      const std::size_t first = Index(axis, 0, 0, z);
      Layer changes = (low.at ^ next[axis]) & (on_near_faces ? on_faces : ~on_faces);
      for (; changes != 0; changes &= changes - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(changes));
        BlockEdge edge = kEdgesOfLayer[i];
        edge.axis = axis;
        edge.low[2] = static_cast<std::uint8_t>(z);
        edge.low_is_inside = (low.at >> i & 1U) != 0;
        edge.near_faces = static_cast<std::uint8_t>(edge.near_faces & (z == 0 ? 7U : 3U));
        edge.index = static_cast<std::uint16_t>(edge.index + first);
        edges->push_back(edge);
      }
    }
  }
}

// For each edge of a cube: how far its Index() is from that of the edge along axis 0 at the cell's corner.
constexpr std::array<std::uint16_t, kCubeEdges.size()> kEdgeOffsets = [] {
  std::array<std::uint16_t, kCubeEdges.size()> offsets{};
  for (std::size_t edge = 0; edge < offsets.size(); ++edge) {
    const auto low = static_cast<std::size_t>(kCubeEdges[edge].low);
    offsets[edge] = static_cast<std::uint16_t>(Index(edge / 4, low & 1U, low >> 1U & 1U, low >> 2U));
  }
  return offsets;
}();

// The triangles of a cube, their corners by kEdgeOffsets. The items past `count` repeat the first one.
struct CellTriangles {
  std::size_t count = 0;
  std::array<std::array<std::uint16_t, 3>, CubeTriangles::kMost> all{};
};

const std::array<CellTriangles, 256>& CellTable() {
  static const std::array<CellTriangles, 256> table = [] {
    std::array<CellTriangles, 256> made;
    for (std::size_t inside = 0; inside < made.size(); ++inside) {
      const CubeTriangles& cut = CubeTable()[inside];
      made[inside].count = cut.count;
      for (std::size_t i = 0; i < CubeTriangles::kMost; ++i)
        for (std::size_t corner = 0; corner < 3; ++corner)
          made[inside].all[i][corner] = kEdgeOffsets[cut.all[i < cut.count ? i : 0][corner]];
    }
    return made;
  }();
  return table;
}

static_assert(VertexNumbers::kEdges == Index(3, 0, 0, 0));

// Sets the numbers of the first block's edges that have a vertex; on the far faces they are in the next
// blocks.
void SetNumbers(std::span<const BlockNeighbour> blocks, std::int32_t* numbers) {
  for (const BlockNeighbour& block : blocks) {
    const unsigned steps = block.steps;
    const std::size_t shift =
        Index(0, (steps & 1U) * kBlockCells, (steps >> 1U & 1U) * kBlockCells, (steps >> 2U) * kBlockCells);
    const std::span<const BlockEdge> edges = block.surface->edges;
    std::int32_t number = block.first_vertex;
    for (const BlockEdge& edge : steps == 0 ? edges : edges.first(block.surface->near_edges)) {
      if ((steps & ~unsigned{edge.near_faces}) == 0) numbers[shift + edge.index] = number;
      ++number;
    }
  }
}

}  // namespace

BlockSurface CutBlock(const HullLattice& lattice, const HullBlock& block) {
  BlockSurface surface;
  surface.labels = lattice.LabelsOf(block, &surface.queries);
  const std::array<CubeTriangles, 256>& table = CubeTable();
  VisitCutCells(surface.labels, [&](std::size_t, std::size_t, std::size_t, std::size_t inside) {
    surface.triangles += table[inside].count;
  });
  if (surface.triangles == 0) return surface;
  surface.edges.reserve(surface.triangles);  // enough: about half as many vertices, plus the rim's
  AppendChanges(surface.labels, true, &surface.edges);
  surface.near_edges = surface.edges.size();
  AppendChanges(surface.labels, false, &surface.edges);
  surface.vertices_in_world.resize(surface.edges.size());
  lattice.FindExits(block, surface.edges, surface.vertices_in_world);
  surface.queries += static_cast<std::int64_t>(surface.edges.size());
  return surface;
}

void WriteTriangles(std::span<const BlockNeighbour> blocks, std::span<std::array<std::int32_t, 3>> triangles,
                    VertexNumbers* numbers) {
  std::int32_t* const all_numbers = numbers->numbers_.data();
  static_assert(VertexNumbers::kNone == -1, "all bits are set");
  std::memset(all_numbers, 0xFF, sizeof(numbers->numbers_));
  SetNumbers(blocks, all_numbers);
  const std::array<CellTriangles, 256>& table = CellTable();
  std::size_t next = 0;
  std::int32_t all = 0;  // the bits of all numbers: negative if one is -1
  const auto write = [&](const std::int32_t* cell, const std::array<std::uint16_t, 3>& corners,
                         std::array<std::int32_t, 3>* triangle) {
    *triangle = {cell[corners[0]], cell[corners[1]], cell[corners[2]]};
    all |= (*triangle)[0] | (*triangle)[1] | (*triangle)[2];
  };
  VisitCutCells(blocks.front().surface->labels,
                [&](std::size_t x, std::size_t y, std::size_t z, std::size_t inside) {
                  const std::int32_t* const cell = all_numbers + Index(0, x, y, z);
                  const CellTriangles& cut = table[inside];
                  // How many there are can't be predicted, and a wrong guess costs more than a triangle that
                  // the next cell overwrites.
                  constexpr std::size_t kAtLeast = 3;
                  if (next + kAtLeast <= triangles.size()) {
                    for (std::size_t i = 0; i < kAtLeast; ++i) write(cell, cut.all[i], &triangles[next + i]);
                    for (std::size_t i = kAtLeast; i < cut.count; ++i)
                      write(cell, cut.all[i], &triangles[next + i]);
                  } else {
                    for (std::size_t i = 0; i < cut.count; ++i) write(cell, cut.all[i], &triangles[next + i]);
                  }
                  next += cut.count;
                });
  core::Require(all >= 0, "the surface goes on in the next blocks");
}

}  // namespace elbowroom::recon
