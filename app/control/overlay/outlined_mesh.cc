#include "app/control/overlay/outlined_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/mesh_queries/first_at_place.h"
#include "core/units.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;

Vector3d AreaVector(const core::TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const auto at = [&](std::int32_t i) -> const Vector3d& {
    return mesh.vertices_mm[static_cast<std::size_t>(i)];
  };
  return (at(b) - at(a)).cross(at(c) - at(a));
}

// One side of a triangle, its lower corner first.
struct Side {
  std::int32_t low = 0;
  std::int32_t high = 0;
  std::uint32_t triangle = 0;
  bool is_upward = true;  // the triangle runs from low to high
  [[nodiscard]] bool IsWith(const Side& other) const { return low == other.low && high == other.high; }
};

std::vector<Side> SidesOf(const core::TriangleMesh& mesh) {
  const std::vector<std::int32_t> first = core::FirstAtPlace(mesh);
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (AreaVector(mesh, t).squaredNorm() == 0.0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = first[static_cast<std::size_t>(mesh.triangles[t][i])];
      const std::int32_t b = first[static_cast<std::size_t>(mesh.triangles[t][(i + 1) % 3])];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::ranges::sort(sides, [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return sides;
}

enum class Bend { kNone, kSmooth, kSharp };

// Of two faces that run along their edge in opposite directions, as those of one surface do.
Bend BendOf(const Vector3d& left, const Vector3d& right) {
  const double across = left.cross(right).norm(), along = left.dot(right);
  if (along > 0.0 && across <= 1e-9 * along) return Bend::kNone;
  return std::atan2(across, along) > core::RadiansFromDegrees(kSharpEdgeDeg) ? Bend::kSharp : Bend::kSmooth;
}

}  // namespace

OutlinedMesh::OutlinedMesh(core::SharedMesh mesh) : tree_(std::move(mesh)) {
  const std::vector<Side> sides = SidesOf(tree_.mesh());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].IsWith(sides[begin])) ++end;
    const Side &one = sides[begin], &other = sides[end - 1];
    MeshEdge edge{one.low, one.high, one.triangle, other.triangle, true};
    if (end - begin == 2 && one.is_upward != other.is_upward) {
      const Bend bend =
          BendOf(AreaVector(tree_.mesh(), one.triangle), AreaVector(tree_.mesh(), other.triangle));
      if (bend == Bend::kNone) continue;
      edge.is_sharp = bend == Bend::kSharp;
    }
    edges_.push_back(edge);
  }
}

std::vector<MeshEdge> OutlinedMesh::EdgesSeenFrom(const Vector3d& eye_in_part) const {
  std::vector<bool> faces_eye(mesh().triangles.size());
  for (std::uint32_t t = 0; t < faces_eye.size(); ++t) {
    const Vector3d& corner = mesh().vertices_mm[static_cast<std::size_t>(mesh().triangles[t][0])];
    faces_eye[t] = AreaVector(mesh(), t).dot(eye_in_part - corner) > 0.0;
  }
  std::vector<MeshEdge> seen;
  std::ranges::copy_if(edges_, std::back_inserter(seen), [&](const MeshEdge& edge) {
    return edge.is_sharp || faces_eye[edge.left] != faces_eye[edge.right];
  });
  return seen;
}

std::shared_ptr<const OutlinedMesh> OutlinedMeshes::Of(const core::SharedMesh& mesh) {
  const auto found = std::ranges::find_if(
      made_, [&](const auto& outlined) { return outlined->tree().shared_mesh() == mesh; });
  if (found != made_.end()) return *found;
  std::erase_if(made_, [](const auto& outlined) { return outlined.use_count() == 1; });
  made_.push_back(std::make_shared<const OutlinedMesh>(mesh));
  return made_.back();
}

}  // namespace elbowroom::control
