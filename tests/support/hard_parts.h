// Parts that are hard to judge, in any number of triangles: much of them is about equally near, or thin.
#pragma once

#include <Eigen/Core>
#include <cstdint>

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
// What a laser scanner leaves of a bumpy square: open, bumps upwards from the plane, noise on each vertex,
// and triangles that differ in size by more than ten times. The same seed gives the same mesh.
[[nodiscard]] core::TriangleMesh ScanMesh(double side_mm, int triangles, std::uint64_t seed);

}  // namespace elbowroom::test_support
