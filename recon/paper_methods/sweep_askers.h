// What the sweep's inner loop takes, made from what the sweep knows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/paper_methods/plane_sweep_kernel.h"

namespace elbowroom::recon {

// One a camera, in the space's order. Their points are still to be set: they change from tile to tile and
// from plane to plane.
std::vector<SweepAsker> AskersOf(const SweepSpace& space);

// In frame b, the points of the tile whose central ray meets the plane at `center_in_view`, mm.
SweepPoints PointsOf(const core::RigidTransform& b_from_view, const Eigen::Vector3d& center_in_view);

// The workspace, with the same points.
SweepBox BoxAt(const SweepSpace& space, const Eigen::Vector3d& center_in_view);

}  // namespace elbowroom::recon
