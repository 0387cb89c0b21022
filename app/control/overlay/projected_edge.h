// A straight edge as the curve that a camera's lens makes of it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "core/camera_model.h"

namespace elbowroom::control {

// What is nearer to the camera than this along its axis isn't drawn.
inline constexpr double kOverlayNearMm = 1.0;

struct CurvePoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double depth_mm = 0.0;                               // along the camera's z axis
  Eigen::Vector3d x_in_cam = Eigen::Vector3d::Zero();  // the point itself
};

// Points along the edge's picture, from its part that lies before the camera, in the lens's domain and in
// `frame` (X/Z, Y/Z). Empty: no such part. Between two points the picture is at most 1 px long, by
// CameraModel::PixelStretch, so it is never more than 0.5 px off the straight line between them
// (docs/camera_overlay.md; projected_edge_test). Thread: any.
[[nodiscard]] std::vector<CurvePoint> ProjectEdge(const core::CameraModel& camera,
                                                  const Eigen::AlignedBox2d& frame,
                                                  const Eigen::Vector3d& a_in_cam,
                                                  const Eigen::Vector3d& b_in_cam);

}  // namespace elbowroom::control
