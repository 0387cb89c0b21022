// How far apart two meshes are, triangle by triangle, in long double.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/rigid_transform.h"
#include "core/triangle_mesh.h"

namespace elbowroom::oracles {

using LongVector = Eigen::Matrix<long double, 3, 1>;
using LongTriangle = std::array<LongVector, 3>;

// The gap and a point of each side that shows it; 0 and a common point where they meet.
struct Gap {
  long double distance_mm = 0.0L;
  LongVector on_a = LongVector::Zero();
  LongVector on_b = LongVector::Zero();
};

// The least of all that can be the nearest pair: an edge of each, a corner and a face, an edge through a
// face. A triangle without area is the segment or point that it is.
[[nodiscard]] Gap GapOfTriangles(const LongTriangle& a, const LongTriangle& b);

// Over all pairs of triangles whose boxes are nearer than the least gap so far; points in world. Frames are
// joined in long double, relative to a, so that a common offset costs no digits. Both meshes have triangles.
[[nodiscard]] Gap GapOfMeshes(const core::TriangleMesh& a, const core::RigidTransform& world_from_a,
                              const core::TriangleMesh& b, const core::RigidTransform& world_from_b);

// How often the mesh winds around the point: the solid angles of its triangles, over the sphere's. Closed and
// turned outwards: 1 inside, 0 outside. x_in_mesh in the mesh's frame, not on its surface.
[[nodiscard]] long double WindingNumber(const core::TriangleMesh& mesh, const LongVector& x_in_mesh);

// Whether a vertex of `piece` is inside `whole`, if that is closed; of all surfaces that don't meet, this is
// how one can be within the other.
[[nodiscard]] bool HasVertexInside(const core::TriangleMesh& whole,
                                   const core::RigidTransform& world_from_whole,
                                   const core::TriangleMesh& piece,
                                   const core::RigidTransform& world_from_piece);

}  // namespace elbowroom::oracles
