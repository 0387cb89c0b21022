#include "core/triangle_mesh.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::core {

void ValidateMesh(const TriangleMesh& mesh, const std::string& where) {
  if (mesh.triangles.empty()) {
    throw Error(ErrorKind::kGeometry,
                fmt::format("{}: the mesh has no triangles; export it again as a surface mesh", where));
  }
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    if (!mesh.vertices_mm[i].allFinite()) {
      throw Error(
          ErrorKind::kGeometry,
          fmt::format("{}: vertex {} is not a finite point; repair the mesh before importing it", where, i));
    }
  }
  if (!(mesh.deviation_mm >= 0.0 && std::isfinite(mesh.deviation_mm))) {
    throw Error(ErrorKind::kGeometry, fmt::format("{}: a deviation of {} mm is no length; import it again",
                                                  where, mesh.deviation_mm));
  }
  const auto count = static_cast<std::int64_t>(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::int32_t index : mesh.triangles[i]) {
      if (index < 0 || index >= count) {
        throw Error(ErrorKind::kGeometry,
                    fmt::format("{}: triangle {} refers to vertex {} of {}; the file is damaged", where, i,
                                index, count));
      }
    }
  }
}

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices_mm) bounds.extend(vertex);
  return bounds;
}

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh, const RigidTransform& b_from_a) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices_mm) bounds.extend(b_from_a * vertex);
  return bounds;
}

double VolumeMm3(const TriangleMesh& mesh) {
  // Relative to a vertex of the mesh, so that a mesh far from its origin loses no digits.
  if (mesh.vertices_mm.empty()) return 0.0;
  const Eigen::Vector3d origin = mesh.vertices_mm.front();
  double six_volumes = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = mesh.vertices_mm[static_cast<std::size_t>(a)] - origin;
    const Eigen::Vector3d pb = mesh.vertices_mm[static_cast<std::size_t>(b)] - origin;
    const Eigen::Vector3d pc = mesh.vertices_mm[static_cast<std::size_t>(c)] - origin;
    six_volumes += pa.dot(pb.cross(pc));
  }
  return six_volumes / 6.0;
}

double AreaMm2(const TriangleMesh& mesh) {
  double area_mm2 = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& pa = mesh.vertices_mm[static_cast<std::size_t>(a)];
    area_mm2 += 0.5 * (mesh.vertices_mm[static_cast<std::size_t>(b)] - pa)
                          .cross(mesh.vertices_mm[static_cast<std::size_t>(c)] - pa)
                          .norm();
  }
  return area_mm2;
}

bool IsWatertight(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return false;
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * mesh.triangles.size());
  const auto directed_edge = [](std::int32_t from, std::int32_t to) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32U) |
           static_cast<std::uint32_t>(to);
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    if (a == b || b == c || c == a) return false;
    edges.insert(edges.end(), {directed_edge(a, b), directed_edge(b, c), directed_edge(c, a)});
  }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](std::uint64_t edge) {
    return std::binary_search(edges.begin(), edges.end(), (edge << 32U) | (edge >> 32U));
  });
}

TriangleMesh Transformed(const TriangleMesh& mesh, const RigidTransform& b_from_a) {
  TriangleMesh result = mesh;
  for (Eigen::Vector3d& vertex : result.vertices_mm) vertex = b_from_a * vertex;
  return result;
}

void Append(TriangleMesh& mesh, const TriangleMesh& addition) {
  const auto offset = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), addition.vertices_mm.begin(), addition.vertices_mm.end());
  for (const auto& [a, b, c] : addition.triangles)
    mesh.triangles.push_back({a + offset, b + offset, c + offset});
  mesh.deviation_mm = std::max(mesh.deviation_mm, addition.deviation_mm);
}

std::string ContentHash(const TriangleMesh& mesh) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double), "vertices are hashed as packed doubles");
  XXH3_state_t* state = XXH3_createState();
  XXH3_128bits_reset(state);
  XXH3_128bits_update(state, mesh.vertices_mm.data(), mesh.vertices_mm.size() * sizeof(Eigen::Vector3d));
  XXH3_128bits_update(state, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  if (mesh.deviation_mm > 0.0) XXH3_128bits_update(state, &mesh.deviation_mm, sizeof mesh.deviation_mm);
  const XXH128_hash_t hash = XXH3_128bits_digest(state);
  XXH3_freeState(state);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace elbowroom::core
