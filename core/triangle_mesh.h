// A triangle mesh, and the operations on it that several rooms need.
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
  // Bound on the distance between the mesh and the CAD surface that it approximates, both ways (Hausdorff):
  // the error of tessellation. 0: the mesh is the surface itself.
  double deviation_mm = 0.0;

  [[nodiscard]] bool operator==(const TriangleMesh&) const = default;
};

using SharedMesh = std::shared_ptr<const TriangleMesh>;

// Throws: Error{kGeometry} naming `where`: no triangles, a vertex that is not finite, an index out of range,
// a deviation that is negative or not finite.
void ValidateMesh(const TriangleMesh& mesh, const std::string& where);

[[nodiscard]] Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);
// The bounds of the mesh in frame b.
[[nodiscard]] Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh, const RigidTransform& b_from_a);

// Signed volume by the divergence theorem; meaningful for a closed mesh, positive if oriented outwards.
[[nodiscard]] double VolumeMm3(const TriangleMesh& mesh);
[[nodiscard]] double AreaMm2(const TriangleMesh& mesh);

// True if every directed edge occurs exactly once and its reverse exactly once: the mesh is closed,
// 2-manifold across edges and consistently oriented. False for an empty mesh and for a triangle with a
// repeated vertex.
[[nodiscard]] bool IsWatertight(const TriangleMesh& mesh);

[[nodiscard]] TriangleMesh Transformed(const TriangleMesh& mesh, const RigidTransform& b_from_a);

// Appends `addition` to `mesh`, with its indices shifted. The deviation is the larger of the two.
void Append(TriangleMesh& mesh, const TriangleMesh& addition);

// 128-bit content hash (XXH3) of vertices, triangles and a deviation above 0, in 32 hex digits. A session
// keeps equal meshes once by it.
[[nodiscard]] std::string ContentHash(const TriangleMesh& mesh);

}  // namespace elbowroom::core
