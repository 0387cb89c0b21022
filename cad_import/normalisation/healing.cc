#include "cad_import/normalisation/healing.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "cad_import/normalisation/surface_topology.h"

namespace elbowroom::cad_import {
namespace {

using core::TriangleMesh;
using Triangle = std::array<std::int32_t, 3>;

constexpr double kNoiseRatio = 1e-9;  // of the mesh's diagonal
// A triangle is flat when its height is below this share of its longest edge: rounding, not shape.
constexpr double kFlatRatio = 1e-9;

const Eigen::Vector3d& At(const TriangleMesh& mesh, std::int32_t index) {
  return mesh.vertices_mm[static_cast<std::size_t>(index)];
}

bool HasEqualCorners(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

bool IsFlat(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d ab = At(mesh, t[1]) - At(mesh, t[0]);
  const Eigen::Vector3d ac = At(mesh, t[2]) - At(mesh, t[0]);
  const double longest_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return ab.cross(ac).norm() <= kFlatRatio * longest_squared;
}

void Turn(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

// Drops the triangles for whose index `goes` is true. Returns how many.
std::int64_t DropWhere(OwnedMesh& body, auto goes) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < body.mesh.triangles.size(); ++i) {
    if (goes(i)) continue;
    body.mesh.triangles[kept] = body.mesh.triangles[i];
    body.owner_of_triangle[kept++] = body.owner_of_triangle[i];
  }
  const auto dropped = static_cast<std::int64_t>(body.mesh.triangles.size() - kept);
  body.mesh.triangles.resize(kept);
  body.owner_of_triangle.resize(kept);
  return dropped;
}

// Its corners in ascending order, and whether it turns through them upwards.
struct Footprint {
  Triangle corners;
  bool is_upward = false;
  std::uint32_t triangle = 0;
};

Footprint FootprintOf(const Triangle& triangle, std::uint32_t index) {
  const auto least = static_cast<std::size_t>(std::ranges::min_element(triangle) - triangle.begin());
  const std::int32_t a = triangle[least], b = triangle[(least + 1) % 3], c = triangle[(least + 2) % 3];
  return {{a, std::min(b, c), std::max(b, c)}, b < c, index};
}

// Marks triangles that have the corners of an earlier one in the same cyclic order. A triangle with the
// opposite order stays: it is the back of a sheet, or a place where two bodies meet.
std::vector<std::uint8_t> FindCopies(const TriangleMesh& mesh) {
  std::vector<Footprint> footprints;
  footprints.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    footprints.push_back(FootprintOf(mesh.triangles[i], i));
  const auto shape_of = [](const Footprint& f) { return std::tuple(f.corners, f.is_upward); };
  std::ranges::sort(footprints, {}, [&](const Footprint& f) { return std::tuple(shape_of(f), f.triangle); });
  std::vector<std::uint8_t> is_copy(mesh.triangles.size(), 0);
  for (std::size_t i = 1; i < footprints.size(); ++i)
    if (shape_of(footprints[i]) == shape_of(footprints[i - 1])) is_copy[footprints[i].triangle] = 1;
  return is_copy;
}

double SixVolumes(const TriangleMesh& mesh, const Patch& patch) {
  const Eigen::Vector3d origin = At(mesh, mesh.triangles[patch.triangles.front()][0]);
  double sum = 0.0;
  for (const std::uint32_t i : patch.triangles) {
    const auto& [a, b, c] = mesh.triangles[i];
    sum += (At(mesh, a) - origin).dot((At(mesh, b) - origin).cross(At(mesh, c) - origin));
  }
  return sum;
}

Eigen::AlignedBox3d BoxOf(const TriangleMesh& mesh, const Patch& patch) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t i : patch.triangles)
    for (const std::int32_t corner : mesh.triangles[i]) box.extend(At(mesh, corner));
  return box;
}

// How often the closed patch winds around x: the solid angle that it covers, by Van Oosterom and Strackee's
// formula.
double WindingOf(const TriangleMesh& mesh, const Patch& patch, const Eigen::Vector3d& x) {
  double angle = 0.0;
  for (const std::uint32_t i : patch.triangles) {
    const auto& [ia, ib, ic] = mesh.triangles[i];
    const Eigen::Vector3d a = At(mesh, ia) - x, b = At(mesh, ib) - x, c = At(mesh, ic) - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * std::numbers::pi);
}

// Turns the closed patches that face inwards, but for cavities: those inside an odd number of others.
std::int64_t TurnInverted(TriangleMesh& mesh, const std::vector<Patch>& patches) {
  std::vector<const Patch*> closed;
  for (const Patch& patch : patches)
    if (patch.is_closed && patch.is_orientable) closed.push_back(&patch);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Patch* patch : closed) boxes.push_back(BoxOf(mesh, *patch));
  std::vector<const Patch*> inverted;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (SixVolumes(mesh, *closed[i]) >= 0.0) continue;
    const Eigen::Vector3d x = At(mesh, mesh.triangles[closed[i]->triangles.front()][0]);
    int around = 0;
    for (std::size_t j = 0; j < closed.size(); ++j)
      if (j != i && boxes[j].contains(boxes[i]) && std::abs(WindingOf(mesh, *closed[j], x)) > 0.5) ++around;
    if (around % 2 == 0) inverted.push_back(closed[i]);
  }
  std::int64_t turned = 0;
  for (const Patch* patch : inverted) {
    for (const std::uint32_t i : patch->triangles) Turn(mesh.triangles[i]);
    turned += static_cast<std::int64_t>(patch->triangles.size());
  }
  return turned;
}

std::int64_t Orient(TriangleMesh& mesh, std::span<const EdgeUse> edges) {
  const std::vector<Patch> patches = FindPatches(mesh, edges);
  std::int64_t turned = 0;
  for (const Patch& patch : patches) {
    for (const std::uint32_t i : patch.odd) Turn(mesh.triangles[i]);
    turned += static_cast<std::int64_t>(patch.odd.size());
  }
  return turned + TurnInverted(mesh, patches);
}

void ClearNoise(TriangleMesh& mesh) {
  const Eigen::AlignedBox3d bounds = core::BoundsOf(mesh);
  const double noise_mm = bounds.isEmpty() ? 0.0 : kNoiseRatio * bounds.diagonal().norm();
  // -0 becomes 0 as well: bits are compared.
  for (Eigen::Vector3d& vertex : mesh.vertices_mm)
    vertex = (vertex.array().abs() <= noise_mm).select(0.0, vertex);
}

}  // namespace

void Weld(OwnedMesh& body) {
  TriangleMesh& mesh = body.mesh;
  if (mesh.triangles.empty()) {
    mesh.vertices_mm.clear();
    return;
  }
  ClearNoise(mesh);
  std::vector<unsigned> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles)
    for (const std::int32_t corner : triangle) corners.push_back(static_cast<unsigned>(corner));
  std::vector<unsigned> place(mesh.vertices_mm.size());
  const std::size_t count =
      meshopt_generateVertexRemap(place.data(), corners.data(), corners.size(), mesh.vertices_mm.data(),
                                  mesh.vertices_mm.size(), sizeof(Eigen::Vector3d));
  std::vector<Eigen::Vector3d> vertices_mm(count);
  meshopt_remapVertexBuffer(vertices_mm.data(), mesh.vertices_mm.data(), mesh.vertices_mm.size(),
                            sizeof(Eigen::Vector3d), place.data());
  mesh.vertices_mm = std::move(vertices_mm);
  for (Triangle& triangle : mesh.triangles)
    for (std::int32_t& corner : triangle)
      corner = static_cast<std::int32_t>(place[static_cast<std::size_t>(corner)]);
  (void)DropWhere(body, [&](std::size_t i) { return HasEqualCorners(mesh.triangles[i]); });
}

SurfaceReport Heal(OwnedMesh& body) {
  TriangleMesh& mesh = body.mesh;
  SurfaceReport report;
  if (mesh.triangles.empty()) return report;
  std::vector<EdgeUse> edges = SortedEdgeUses(mesh);
  EdgeCounts counts = CountEdges(edges);
  // Two triangles run the same way along each edge of a copy. So there is no copy where all edges are sound
  // or open.
  if (counts.non_manifold + counts.inconsistent > 0) {
    const std::vector<std::uint8_t> is_copy = FindCopies(mesh);
    report.dropped_duplicates = DropWhere(body, [&](std::size_t i) { return is_copy[i] != 0; });
  }
  if (report.dropped_duplicates > 0) {
    edges = SortedEdgeUses(mesh);
    counts = CountEdges(edges);
  }
  const auto is_flat = [&](std::size_t i) { return IsFlat(mesh, mesh.triangles[i]); };
  if (counts.are_closed()) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) report.kept_flat += is_flat(i) ? 1 : 0;
  } else {
    report.dropped_flat = DropWhere(body, is_flat);
  }
  if (report.dropped_flat + report.dropped_duplicates > 0) {
    Weld(body);  // drops the vertices that no triangle uses now
    edges = SortedEdgeUses(mesh);
  }
  report.turned = Orient(mesh, edges);
  if (report.turned > 0) edges = SortedEdgeUses(mesh);
  counts = CountEdges(edges);
  report.open_edges = counts.open;
  report.non_manifold_edges = counts.non_manifold;
  report.inconsistent_edges = counts.inconsistent;
  report.watertight = counts.are_closed() && !mesh.triangles.empty();
  return report;
}

}  // namespace elbowroom::cad_import
