// A point in space from its pixels.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/rigid_transform.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

struct PointSight {
  const LensParameters* lens = nullptr;
  core::RigidTransform cam_from_world;
  Eigen::Vector2d pixel;
};

// argmin over X of the sum of |project(X) - pixel|^2, in mm; nothing: fewer than two sights, rays that are
// parallel to rounding, or a point behind a camera.
[[nodiscard]] std::optional<Eigen::Vector3d> Triangulate(std::span<const PointSight> sights);

}  // namespace elbowroom::recon
