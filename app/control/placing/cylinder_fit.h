// The axis of a hole or a pin, from the triangles of its wall.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "core/triangle_mesh.h"

namespace elbowroom::control {

struct FittedCylinder {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // of the axis, in the middle of the wall's length
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double radius_mm = 0.0;
  double length_mm = 0.0;  // of the wall along the axis
  bool is_hole = false;    // its wall faces the axis
  double off_mm = 0.0;     // the farthest that one of its corners is off the cylinder
};

// The direction that is most across the triangles' normals, weighted by their areas; then the circle through
// the corners seen along it, by least squares of their distances (docs/layout_editing.md). Nothing where that
// isn't a cylinder: corners that are off by more than 2 % of the radius, facets wider than 40 degrees, or a
// wall that goes around by less than 60 degrees, a plane for one. All in the mesh's frame, exact for the
// corners of a tessellated cylinder but for rounding (placing_test).
[[nodiscard]] std::optional<FittedCylinder> FitCylinder(const core::TriangleMesh& mesh,
                                                        std::span<const std::uint32_t> triangles);

}  // namespace elbowroom::control
