// What one camera says of a ball: the inner step of every hull query.
#pragma once

#include <Eigen/Core>

#include "core/camera_model.h"
#include "recon/silhouette.h"

namespace elbowroom::recon {

struct CameraAnswer {
  bool is_object = false;         // the label of the point, exterior label where the camera can't see it
  bool is_seen = false;           // the point is in the picture
  double radius_mm = 0.0;         // certified: the label holds this far around
  double seen_radius_mm = 0.0;    // certified: if seen, all points this near are in the picture too; else 0
  double unseen_radius_mm = 0.0;  // certified: if unseen, all points this near are unseen too; else 0
};

// Frames: x_in_world. Exact as the silhouette's labels are; derivation in docs/algorithms.md.
[[nodiscard]] CameraAnswer AskCamera(const core::CameraModel& camera, const Silhouette& silhouette,
                                     bool exterior_is_object, const Eigen::Vector3d& x_in_world);

// The label alone.
[[nodiscard]] bool IsObjectTo(const core::CameraModel& camera, const Silhouette& silhouette,
                              bool exterior_is_object, const Eigen::Vector3d& x_in_world);

}  // namespace elbowroom::recon
