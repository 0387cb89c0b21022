#include "app/control/placing/surface_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/mesh_queries/first_at_place.h"
#include "core/units.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using Edge = std::pair<std::int32_t, std::int32_t>;

void ThrowIfStopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw core::Error(core::ErrorKind::kCancelled, "the surface isn't looked at");
}

Vector3d UnitNormal(const core::TriangleMesh& mesh, std::uint32_t triangle) {
  const auto vertex = [&](std::size_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(mesh.triangles[triangle][i])];
  };
  return (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).normalized();
}

std::array<Edge, 3> EdgesOf(const core::TriangleMesh& mesh, const std::vector<std::int32_t>& welded,
                            std::uint32_t triangle) {
  std::array<Edge, 3> edges;
  for (std::size_t i = 0; i < 3; ++i)
    edges[i] = std::minmax(welded[static_cast<std::size_t>(mesh.triangles[triangle][i])],
                           welded[static_cast<std::size_t>(mesh.triangles[triangle][(i + 1) % 3])]);
  return edges;
}

}  // namespace

std::vector<std::uint32_t> SmoothPatch(const core::TriangleMesh& mesh, std::uint32_t triangle,
                                       double turn_deg, const std::stop_token& stop) {
  core::Require(triangle < mesh.triangles.size(), "a triangle of the mesh");
  const std::vector<std::int32_t> welded = core::FirstAtPlace(mesh);
  std::map<Edge, std::vector<std::uint32_t>> beside;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    ThrowIfStopped(stop);
    for (const Edge& edge : EdgesOf(mesh, welded, i)) beside[edge].push_back(i);
  }
  const double least_cosine = std::cos(core::RadiansFromDegrees(turn_deg));
  std::vector<bool> is_taken(mesh.triangles.size(), false);
  std::vector<std::uint32_t> patch{triangle};
  is_taken[triangle] = true;
  for (std::size_t next = 0; next < patch.size(); ++next) {
    ThrowIfStopped(stop);
    const Vector3d normal = UnitNormal(mesh, patch[next]);
    for (const Edge& edge : EdgesOf(mesh, welded, patch[next])) {
      for (const std::uint32_t other : beside[edge]) {
        // A triangle without area has the normal 0 and passes no test.
        if (is_taken[other] || !(normal.dot(UnitNormal(mesh, other)) >= least_cosine)) continue;
        is_taken[other] = true;
        patch.push_back(other);
      }
    }
  }
  std::ranges::sort(patch);
  return patch;
}

}  // namespace elbowroom::control
