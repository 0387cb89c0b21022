// How a point's pixel moves with the point and with the camera's parameters.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/rigid_transform.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

struct PixelResponse {
  Eigen::Matrix<double, 2, 3> by_x_in_world;  // px / mm
  // 2 x ParameterBlock::size(), in the block's order: px / unit of each parameter. A point stands still, so
  // the time offset's column is 0.
  Eigen::Matrix2Xd by_parameters;
};

// Nothing: the point isn't before the camera.
[[nodiscard]] std::optional<PixelResponse> PixelResponseAt(const LensParameters& lens,
                                                           const core::RigidTransform& cam_from_world,
                                                           const Eigen::Vector3d& x_in_world);

}  // namespace elbowroom::recon
