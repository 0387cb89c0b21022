// How a tangency's residual answers to what may be wrong with its two cameras.
#pragma once

#include <Eigen/Core>

#include "recon/consistency/epipolar_pairs.h"
#include "recon/consistency/tangencies.h"

namespace elbowroom::recon {

// A small change of a camera's pose: a turn w about the camera's axes, in rad, with which its rotation is
// exp(w) * rotation_cam_from_world, and a shift of its centre in world, in mm. In this order: w, shift.
using PoseChange = Eigen::Matrix<double, 6, 1>;

// Derivatives of residual_px by what is true of camera a and b but isn't in the calibration.
struct TangencyResponse {
  PoseChange by_pose_a, by_pose_b;  // px / rad, px / mm
  // The silhouette's boundary is farther out all around: px / px.
  double by_dilation_a = 0.0, by_dilation_b = 0.0;
  // The plane's angle in one camera: px / rad. Times the angle's rate it is by the camera's time offset.
  double by_angle_a = 0.0, by_angle_b = 0.0;
};

// To the first order; a tangent is an extremum, so that where it touches doesn't matter (docs/consistency.md;
// rig_watch_test holds it to differences).
[[nodiscard]] TangencyResponse ResponseOf(const EpipolarPairs& pairs, const Tangency& tangency);

// The mean of J'J over the camera's picture, J being the derivative of a pixel by the pose, for points at
// that distance. sqrt(change' Q change) is the root mean square shift of the picture in px.
[[nodiscard]] Eigen::Matrix<double, 6, 6> ShiftSquares(const core::CameraModel& camera, double focal_px,
                                                       double distance_mm);

}  // namespace elbowroom::recon
