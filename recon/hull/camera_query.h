// One camera's answer for a point, a ball or a shape: the inner step of the hull's queries.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "core/camera_model.h"
#include "recon/contours/silhouette.h"
#include "recon/hull/world_shape.h"

namespace elbowroom::recon {

// The label that a plane gives to a point, and a ball around it in which the label holds. Points behind the
// camera are exterior.
struct BallLabel {
  bool is_object = false;
  double radius_mm = 0.0;  // certified: the label holds this far around the point
};

// Frames: x_in_world. `focal_px` is the plane's. Derivation in docs/algorithms.md. A radius that is sure to
// be at least, or sure to be less than, `enough_mm` isn't worked out any closer.
[[nodiscard]] BallLabel AskPlane(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                                 const Eigen::Vector3d& x_in_world,
                                 double enough_mm = std::numeric_limits<double>::infinity());

// How near to a point a plane's label surely changes; infinite if that isn't known. The nearest edge, at
// distance d in the picture, is the picture of a point at the same z that is z d / f away.
[[nodiscard]] double ChangesWithinMm(const core::CameraModel& camera, double focal_px,
                                     const ContourMap& labels, const Eigen::Vector3d& x_in_world);

// The label that a plane gives to all points of a shape. Nothing if it gives both labels, or if that isn't
// certain: for a shape that reaches behind the camera, covers too many rows of cells, or isn't separated from
// an edge by the lines that are tried (IsClearOfEdges).
[[nodiscard]] std::optional<bool> LabelOfShape(const core::CameraModel& camera, double focal_px,
                                               const ContourMap& labels, const WorldShape& shape);

// The label alone.
[[nodiscard]] bool IsObjectTo(const core::CameraModel& camera, double focal_px, const ContourMap& labels,
                              const Eigen::Vector3d& x_in_world);

// The label of a point in the camera's frame, by parity. It builds no grid of cells, so it suits a few points
// a frame.
[[nodiscard]] bool LabelInCam(const ContourMap& labels, double focal_px, const Eigen::Vector3d& x_in_cam);

}  // namespace elbowroom::recon
