// What one camera says of a ball: the inner step of every hull query.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "core/camera_model.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/world_shape.h"

namespace elbowroom::recon {

// What a labelled plane says of a point and of the ball around it. Points behind the camera are exterior.
struct BallLabel {
  bool is_object = false;
  double radius_mm = 0.0;  // certified: the label holds this far around
};

// Frames: x_in_world. `focal_px` is the plane's. Derivation in docs/algorithms.md. A radius that is sure to
// be at least, or sure to be less than, `enough_mm` isn't worked out any closer.
[[nodiscard]] BallLabel AskPlane(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                                 const Eigen::Vector3d& x_in_world,
                                 double enough_mm = std::numeric_limits<double>::infinity());

// The label that a plane gives to every point of a shape; nothing where it gives both, or that isn't certain:
// one that reaches behind the camera, or covers much of the picture (contour_kernel.h).
[[nodiscard]] std::optional<bool> LabelOfShape(const core::CameraModel& camera, double focal_px,
                                               const ContourMap& labels, const WorldShape& shape);

// The label alone.
[[nodiscard]] bool IsObjectTo(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                              const Eigen::Vector3d& x_in_world);

// The label of a point in the camera's frame, by parity: builds nothing. For one point in a frame.
[[nodiscard]] bool LabelInCam(const ContourMap& labels, double focal_px, const Eigen::Vector3d& x_in_cam);

}  // namespace elbowroom::recon
