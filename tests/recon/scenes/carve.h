// The hull's volume the slow, obviously right way.
#pragma once

#include <Eigen/Geometry>

#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// Counts the centres of side^3 voxels of the box that are in the hull.
[[nodiscard]] double CarvedVolumeMm3(const VisualHull& hull, const Eigen::AlignedBox3d& box_mm, int side);

}  // namespace elbowroom::recon
