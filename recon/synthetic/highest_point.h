// How high real things reach above a place: the truth that a space needed is held against.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "recon/synthetic/solids.h"

namespace elbowroom::recon {

// z of the highest point, in the world, of what of the solid stands above the rectangle (x, y); nothing: none
// does. Exact but for rounding (highest_point_test). A tube counts as full.
[[nodiscard]] std::optional<double> HighestZMm(const Solid& solid, const Eigen::AlignedBox2d& above_mm);

// Of all of them.
[[nodiscard]] std::optional<double> HighestZMm(std::span<const SyntheticObject> objects,
                                               const Eigen::AlignedBox2d& above_mm);

}  // namespace elbowroom::recon
