// A triangle mesh and the few questions every room asks of one.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/rigid_transform.h"

namespace elbowroom::core {

// Vertices in millimetres in the mesh's own frame; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_mm;
  std::vector<std::array<std::int32_t, 3>> triangles;
  // How far a point of the surface that it stands for may be from it, and a point of it from that surface:
  // what tessellation cost. 0: it is the surface itself.
  double deviation_mm = 0.0;

  [[nodiscard]] bool operator==(const TriangleMesh&) const = default;
};

using SharedMesh = std::shared_ptr<const TriangleMesh>;

// Throws: Error{kGeometry} naming `where`: no triangles, a vertex that is not finite, an index out of range,
// a deviation that is no length.
void ValidateMesh(const TriangleMesh& mesh, const std::string& where);

[[nodiscard]] Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);
// The bounds, in frame b, of the mesh as it stands there.
[[nodiscard]] Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh, const RigidTransform& b_from_a);

// Signed volume by the divergence theorem; meaningful for a closed mesh, positive if oriented outwards.
[[nodiscard]] double VolumeMm3(const TriangleMesh& mesh);
[[nodiscard]] double AreaMm2(const TriangleMesh& mesh);

// True if every directed edge occurs exactly once and its reverse exactly once: closed, 2-manifold across
// edges and consistently oriented. Empty: false.
[[nodiscard]] bool IsWatertight(const TriangleMesh& mesh);

[[nodiscard]] TriangleMesh Transformed(const TriangleMesh& mesh, const RigidTransform& b_from_a);

// Appends `addition` to `mesh`, indices shifted; the larger deviation is that of both.
void Append(TriangleMesh& mesh, const TriangleMesh& addition);

// 128-bit content hash (XXH3) of vertices, triangles and a deviation above 0, 32 hex digits: equal meshes
// share a row in a session.
[[nodiscard]] std::string ContentHash(const TriangleMesh& mesh);

}  // namespace elbowroom::core
