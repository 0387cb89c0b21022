// Parts that are hard to judge, in any number of triangles: much of them is about equally near, or thin.
#pragma once

#include <Eigen/Core>

#include "core/triangle_mesh.h"

namespace elbowroom::test_support {

// All have about `triangles` triangles, and stand around the origin. Lengths in millimetres.

// Closed; outwards.
[[nodiscard]] core::TriangleMesh SphereMesh(double radius_mm, int triangles);
// The same, inwards: the wall of a round cavity.
[[nodiscard]] core::TriangleMesh ShellMesh(double radius_mm, int triangles);
// The wall of a bore along x, without ends.
[[nodiscard]] core::TriangleMesh BoreMesh(double radius_mm, double length_mm, int triangles);
// Spikes upwards from a square, side by side, of three triangles each; a third as thick as they are apart.
[[nodiscard]] core::TriangleMesh NeedleForestMesh(double side_mm, double height_mm, int triangles);

}  // namespace elbowroom::test_support
