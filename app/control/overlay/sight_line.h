// Whether a part stands between an eye and a point.
#pragma once

#include <Eigen/Core>

#include "core/bvh.h"

namespace elbowroom::control {

// Both points in the part's frame. True if a triangle, seen from either side, meets the line from
// `from_share` of the way to just before the point: what is nearer to the point than a millionth of the way,
// as the faces of the edge that it lies on, doesn't hide it. Tested against all triangles
// (overlay_pieces_test). Thread: any.
[[nodiscard]] bool IsHidden(const core::TriangleTree& part, const Eigen::Vector3d& eye_in_part,
                            const Eigen::Vector3d& x_in_part, double from_share = 0.0);

}  // namespace elbowroom::control
