#include "recon/hull_mesh.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

constexpr int kLargestLevel = 20;
constexpr int kBisections = 11;
// Vertices keep this share of an edge away from its ends, so that no two of them fall together: in float32
// too, while the workspace is less than some 8000 edges long. Small enough to stay within edge / 1000 of the
// change along a cube's diagonal.
constexpr double kEndShare = 1.0 / 2048;

using GridPoint = Eigen::Vector3i;

std::uint64_t PackKey(const GridPoint& p) {
  return (static_cast<std::uint64_t>(p.z()) << 42U) | (static_cast<std::uint64_t>(p.y()) << 21U) |
         static_cast<std::uint64_t>(p.x());
}
GridPoint UnpackKey(std::uint64_t key) {
  constexpr std::uint64_t kMask = (1U << 21U) - 1U;
  return {static_cast<int>(key & kMask), static_cast<int>((key >> 21U) & kMask),
          static_cast<int>(key >> 42U)};
}

// Grid point (i, j, k) stands at origin + edge * (i, j, k); the outermost layer lies outside the workspace.
struct Grid {
  Eigen::Vector3d origin_in_world;
  double edge_mm;
  GridPoint cells;  // in each direction
  int level;        // 2^level cells cover the longest side

  [[nodiscard]] Eigen::Vector3d At(const GridPoint& p) const {
    return origin_in_world + edge_mm * p.cast<double>();
  }
};

Grid MakeGrid(const Eigen::AlignedBox3d& workspace_mm, double edge_mm) {
  if (!(edge_mm > 0.0) || !std::isfinite(edge_mm)) {
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("hull mesh: the edge length must be positive, not {} mm", edge_mm));
  }
  const Eigen::Vector3d cells = (workspace_mm.sizes() / edge_mm).array().ceil() + 2.0;
  if (cells.maxCoeff() > (1 << kLargestLevel)) {
    throw core::Error(
        core::ErrorKind::kRange,
        fmt::format("hull mesh: edges of {} mm need {:.0f} cells a side, more than 2^{}; choose longer edges",
                    edge_mm, cells.maxCoeff(), kLargestLevel));
  }
  Grid grid{workspace_mm.center() - 0.5 * edge_mm * cells, edge_mm, cells.cast<int>(), 0};
  while ((1 << grid.level) < grid.cells.maxCoeff()) ++grid.level;
  return grid;
}

struct CellSearch {
  const VisualHull& hull;
  const Grid& grid;
  std::vector<std::uint64_t> mixed;
  std::int64_t queries = 0;

  void Visit(const GridPoint& corner, int level) {
    if ((corner.array() >= grid.cells.array()).any()) return;
    const int size = 1 << level;
    const Eigen::Vector3d center = grid.At(corner) + Eigen::Vector3d::Constant(0.5 * size * grid.edge_mm);
    const double radius_mm = 0.5 * std::sqrt(3.0) * size * grid.edge_mm * (1.0 + 1e-12);
    ++queries;
    if (hull.Classify(center, radius_mm) != BallAnswer::kMixed) return;
    if (level == 0) {
      mixed.push_back(PackKey(corner));
      return;
    }
    for (int child = 0; child < 8; ++child) {
      Visit(corner + GridPoint(child & 1, (child >> 1) & 1, child >> 2) * (size / 2), level - 1);
    }
  }
};

std::vector<std::uint64_t> MixedCells(const VisualHull& hull, const Grid& grid, std::int64_t* queries,
                                      const core::Progress& progress, const std::stop_token& stop) {
  const int block_level = std::max(grid.level - 4, 0), block_cells = 1 << block_level;
  const GridPoint blocks = (grid.cells.array() + (block_cells - 1)) / block_cells;
  std::vector<std::uint64_t> cells;
  // Layer by layer: the layers' end is where progress is told and a stop is heeded, on the caller's thread.
  for (int layer = 0; layer < blocks.z(); ++layer) {
    core::ThrowIfStopped(stop, "meshing the hull");
    const int count = blocks.x() * blocks.y();
    std::vector<CellSearch> searches(static_cast<std::size_t>(count), {hull, grid, {}, 0});
    tbb::parallel_for(0, count, [&](int i) {
      const GridPoint block(i % blocks.x(), i / blocks.x(), layer);
      searches[static_cast<std::size_t>(i)].Visit(block * block_cells, block_level);
    });
    for (const CellSearch& search : searches) {
      cells.insert(cells.end(), search.mixed.begin(), search.mixed.end());
      *queries += search.queries;
    }
    progress.Report(layer + 1, blocks.z(), "hull cells");
  }
  core::ThrowIfStopped(stop, "meshing the hull");
  return cells;
}

void SortUnique(std::vector<std::uint64_t>* keys) {
  tbb::parallel_sort(keys->begin(), keys->end());
  keys->erase(std::unique(keys->begin(), keys->end()), keys->end());
}

std::uint32_t IndexOf(const std::vector<std::uint64_t>& sorted, std::uint64_t key) {
  return static_cast<std::uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), key) - sorted.begin());
}

// The six tetrahedra of a cube around its main diagonal; corner c stands at (c & 1, c >> 1 & 1, c >> 2).
// Every face of the cube is cut along the same diagonal from both sides.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

GridPoint CornerOffset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }

struct CubeEdge {
  int inside;
  int outside;
};

// The surface's polygon in one tetrahedron: three or four cut edges in cyclic order.
struct Polygon {
  std::array<CubeEdge, 4> edges{};
  std::size_t size = 0;
};

Polygon CutTetrahedron(const std::array<int, 4>& tetrahedron, const std::array<bool, 8>& inside) {
  std::array<int, 4> in{}, out{};
  std::size_t ins = 0, outs = 0;
  for (const int corner : tetrahedron) {
    if (inside[static_cast<std::size_t>(corner)]) {
      in[ins++] = corner;
    } else {
      out[outs++] = corner;
    }
  }
  if (ins == 1) return {{{{in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]}}}, 3};
  if (ins == 2) return {{{{in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]}, {in[1], out[0]}}}, 4};
  if (ins == 3) return {{{{in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]}}}, 3};
  return {};
}

// Whether the polygon, as listed, is counter-clockwise seen from outside; whole-number geometry on the edges'
// midpoints, so never in doubt.
bool FacesOutward(const Polygon& polygon) {
  const auto midpoint = [](const CubeEdge& edge) -> GridPoint {
    return CornerOffset(edge.inside) + CornerOffset(edge.outside);
  };
  const GridPoint a = midpoint(polygon.edges[0]), b = midpoint(polygon.edges[1]),
                  c = midpoint(polygon.edges[2]);
  const GridPoint outward = CornerOffset(polygon.edges[0].outside) - CornerOffset(polygon.edges[0].inside);
  return (b - a).cross(c - a).dot(outward) > 0;
}

using EdgeTriangle =
    std::array<std::uint64_t, 3>;  // three cut edges: inside corner's index, outside corner's

void CutCell(const std::array<std::uint32_t, 8>& corner_index, const std::array<bool, 8>& inside,
             std::vector<EdgeTriangle>* triangles) {
  for (const auto& tetrahedron : kTetrahedra) {
    const Polygon polygon = CutTetrahedron(tetrahedron, inside);
    if (polygon.size == 0) continue;
    const bool is_outward = FacesOutward(polygon);
    const auto key = [&](const CubeEdge& edge) {
      return (std::uint64_t{corner_index[static_cast<std::size_t>(edge.inside)]} << 32U) |
             corner_index[static_cast<std::size_t>(edge.outside)];
    };
    for (std::size_t i = 2; i < polygon.size; ++i) {
      const std::uint64_t second = key(polygon.edges[i - 1]), third = key(polygon.edges[i]);
      triangles->push_back({key(polygon.edges[0]), is_outward ? second : third, is_outward ? third : second});
    }
  }
}

Eigen::Vector3d CrossingOnEdge(const VisualHull& hull, const Eigen::Vector3d& inside,
                               const Eigen::Vector3d& outside) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (hull.Contains(inside + middle * (outside - inside)) ? low : high) = middle;
  }
  return inside + std::clamp(0.5 * (low + high), kEndShare, 1.0 - kEndShare) * (outside - inside);
}

// All corners of the cells, sorted, and whether each is in the hull.
struct Corners {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> inside;
};

Corners AskCorners(const VisualHull& hull, const Grid& grid, const std::vector<std::uint64_t>& cells) {
  Corners corners;
  corners.keys.reserve(cells.size() * 8);
  for (const std::uint64_t cell : cells) {
    for (int corner = 0; corner < 8; ++corner)
      corners.keys.push_back(PackKey(UnpackKey(cell) + CornerOffset(corner)));
  }
  SortUnique(&corners.keys);
  corners.inside.resize(corners.keys.size());
  tbb::parallel_for(std::size_t{0}, corners.keys.size(), [&](std::size_t i) {
    corners.inside[i] = hull.Contains(grid.At(UnpackKey(corners.keys[i]))) ? 1 : 0;
  });
  return corners;
}

std::vector<EdgeTriangle> CutCells(const std::vector<std::uint64_t>& cells, const Corners& corners) {
  std::vector<EdgeTriangle> triangles;
  for (const std::uint64_t cell : cells) {
    std::array<std::uint32_t, 8> index{};
    std::array<bool, 8> inside{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      index[corner] =
          IndexOf(corners.keys, PackKey(UnpackKey(cell) + CornerOffset(static_cast<int>(corner))));
      inside[corner] = corners.inside[index[corner]] != 0;
    }
    CutCell(index, inside, &triangles);
  }
  return triangles;
}

}  // namespace

HullMesh MeshHull(const VisualHull& hull, double edge_mm, const core::Progress& progress,
                  std::stop_token stop) {
  const Grid grid = MakeGrid(hull.rig().workspace_mm, edge_mm);
  HullMesh result;
  const std::vector<std::uint64_t> cells = MixedCells(hull, grid, &result.queries, progress, stop);
  result.cells = static_cast<std::int64_t>(cells.size());
  result.skipped_cells = grid.cells.cast<std::int64_t>().prod() - result.cells;
  const Corners corners = AskCorners(hull, grid, cells);
  const std::vector<EdgeTriangle> triangles = CutCells(cells, corners);
  core::ThrowIfStopped(stop, "meshing the hull");

  std::vector<std::uint64_t> edges;
  edges.reserve(triangles.size() * 3);
  for (const EdgeTriangle& triangle : triangles) edges.insert(edges.end(), triangle.begin(), triangle.end());
  SortUnique(&edges);
  result.mesh.vertices_mm.resize(edges.size());
  tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) {
    if (stop.stop_requested()) return;
    const Eigen::Vector3d inside = grid.At(UnpackKey(corners.keys[edges[i] >> 32U]));
    const Eigen::Vector3d outside = grid.At(UnpackKey(corners.keys[edges[i] & 0xffffffffU]));
    result.mesh.vertices_mm[i] = CrossingOnEdge(hull, inside, outside);
  });
  core::ThrowIfStopped(stop, "meshing the hull");
  result.queries += static_cast<std::int64_t>(corners.keys.size() + edges.size() * kBisections);
  result.mesh.triangles.reserve(triangles.size());
  for (const EdgeTriangle& triangle : triangles) {
    const auto vertex = [&](std::size_t i) { return static_cast<std::int32_t>(IndexOf(edges, triangle[i])); };
    result.mesh.triangles.push_back({vertex(0), vertex(1), vertex(2)});
  }
  return result;
}

}  // namespace elbowroom::recon
