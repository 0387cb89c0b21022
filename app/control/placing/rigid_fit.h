// CAD registered to the rig: the rigid motion between points of a part and the same points measured in world.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rigid_transform.h"

namespace elbowroom::control {

struct PointPair {
  Eigen::Vector3d x_in_part = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_in_world = Eigen::Vector3d::Zero();  // measured
};

struct RigidFit {
  core::RigidTransform world_from_part;
  std::vector<double> residuals_mm;  // one a pair: how far the part's point ends up from the measured one
  double rms_mm = 0.0;
  double largest_mm = 0.0;
  // How far the points spread across their longest line, root mean square: the lever by which a turn about it
  // is held. Small beside the residuals: measure points farther apart.
  double spread_mm = 0.0;
};

// The motion with the least sum of squared residuals, by the singular values of the pairs' covariance; a
// mirror image is never the answer. Source: Kabsch 1976, Umeyama 1991 (without scale).
// Throws: Error{kRange} for fewer than three pairs, or points that lie on one line in part or world: then a
// turn about the line isn't known.
[[nodiscard]] RigidFit FitRigid(const std::vector<PointPair>& pairs);

}  // namespace elbowroom::control
