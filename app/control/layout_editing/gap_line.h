// Where a spacing's gap is drawn.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "core/layout.h"
#include "core/rigid_transform.h"

namespace elbowroom::control {

// The ends of the line that shows the gap, in world: on the reference, then on what moves. Across its axis
// the line is in the middle of what the boxes of both ends have in common, or in the middle of the moving end
// if they have nothing in common.
[[nodiscard]] std::array<Eigen::Vector3d, 2> GapLine(const core::Layout& layout, const core::Spacing& gap,
                                                     std::span<const core::RigidTransform> world_from_parts);

}  // namespace elbowroom::control
