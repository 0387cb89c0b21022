#include "app/control/section/mesh_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "app/control/section/filled_outline.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

recon::HalfSpace InMesh(const recon::HalfSpace& in_world, const core::RigidTransform& world_from_mesh) {
  return {world_from_mesh.rotation.transpose() * in_world.outward,
          -in_world.BeyondMm(world_from_mesh.translation_mm)};
}

// Where a side meets the plane: the same point whichever way the side is run along.
Vector3d MeetingOf(const recon::HalfSpace& kept, const Vector3d& a, const Vector3d& b) {
  const bool is_turned = std::array{b.x(), b.y(), b.z()} < std::array{a.x(), a.y(), a.z()};
  const Vector3d &from = is_turned ? b : a, &to = is_turned ? a : b;
  const double begin = kept.BeyondMm(from), end = kept.BeyondMm(to);
  return from + begin / (begin - end) * (to - from);
}

class Cutter {
 public:
  explicit Cutter(const recon::HalfSpace& kept)
      : kept_(kept), u_(kept.outward.unitOrthogonal()), v_(kept.outward.cross(u_)) {}

  // Keeps what is left of the triangle, and of a cut one the side of the cut's face, which runs against the
  // triangle's own way.
  void Cut(const Triangle& triangle, std::vector<Triangle>* kept) {
    std::vector<Vector3d> polygon;
    Vector3d leaves = Vector3d::Zero(), enters = Vector3d::Zero();
    bool is_cut = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d &from = triangle[i], &to = triangle[(i + 1) % 3];
      const bool from_stays = kept_.BeyondMm(from) <= 0.0, to_stays = kept_.BeyondMm(to) <= 0.0;
      if (from_stays) polygon.push_back(from);
      if (from_stays == to_stays) continue;
      const Vector3d meeting = MeetingOf(kept_, from, to);
      polygon.push_back(meeting);
      (from_stays ? leaves : enters) = meeting;
      is_cut = true;
    }
    for (std::size_t i = 2; i < polygon.size(); ++i)
      kept->push_back({polygon[0], polygon[i - 1], polygon[i]});
    if (is_cut) outline_.push_back({Flat(enters), Flat(leaves)});
  }

  void AddFaces(std::vector<Triangle>* faces) const {
    for (const FlatTriangle& flat : FillOutline(outline_))
      faces->push_back({InSpace(flat[0]), InSpace(flat[1]), InSpace(flat[2])});
  }

 private:
  [[nodiscard]] Vector2d Flat(const Vector3d& x) const { return {u_.dot(x), v_.dot(x)}; }
  [[nodiscard]] Vector3d InSpace(const Vector2d& x) const {
    return x.x() * u_ + x.y() * v_ + kept_.at_mm * kept_.outward;
  }

  recon::HalfSpace kept_;
  Vector3d u_, v_;  // across the normal; u x v is the normal
  std::vector<DirectedSegment> outline_;
};

core::TriangleMesh MeshOf(const std::vector<Triangle>& triangles, double deviation_mm) {
  core::TriangleMesh mesh;
  for (const Triangle& triangle : triangles) {
    const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
    mesh.vertices_mm.insert(mesh.vertices_mm.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.deviation_mm = deviation_mm;
  return mesh;
}

std::vector<Triangle> TrianglesOf(const core::TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    triangles.push_back({mesh.vertices_mm[static_cast<std::size_t>(a)],
                         mesh.vertices_mm[static_cast<std::size_t>(b)],
                         mesh.vertices_mm[static_cast<std::size_t>(c)]});
  return triangles;
}

}  // namespace

CutMesh CutOpen(const core::TriangleMesh& mesh, const core::RigidTransform& world_from_mesh,
                const SectionCut& cut) {
  std::vector<Triangle> surface = TrianglesOf(mesh), faces;
  for (const recon::HalfSpace& half_space : cut.kept) {
    Cutter cutter(InMesh(half_space, world_from_mesh));
    std::vector<Triangle> kept_surface, kept_faces;
    for (const Triangle& triangle : surface) cutter.Cut(triangle, &kept_surface);
    for (const Triangle& triangle : faces) cutter.Cut(triangle, &kept_faces);
    cutter.AddFaces(&kept_faces);
    surface = std::move(kept_surface);
    faces = std::move(kept_faces);
  }
  return {MeshOf(surface, mesh.deviation_mm), MeshOf(faces, mesh.deviation_mm)};
}

core::TriangleMesh CutSurface(const core::TriangleMesh& mesh, const core::RigidTransform& world_from_mesh,
                              const SectionCut& cut) {
  std::vector<Triangle> surface = TrianglesOf(mesh);
  for (const recon::HalfSpace& half_space : cut.kept) {
    Cutter cutter(InMesh(half_space, world_from_mesh));
    std::vector<Triangle> kept;
    for (const Triangle& triangle : surface) cutter.Cut(triangle, &kept);
    surface = std::move(kept);
  }
  return MeshOf(surface, mesh.deviation_mm);
}

}  // namespace elbowroom::control
