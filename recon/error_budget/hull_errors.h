// How far the hull's surface may be off, from the rig's covariance and the silhouettes.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/camera_model.h"
#include "core/error_budget.h"
#include "core/ids.h"
#include "core/rig.h"
#include "core/rig_quality.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"
#include "recon/calibration/pixel_response.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::recon {

// The standard uncertainty of the distance from the hull to a part, to the first order: the distance changes
// by the shifts of the silhouettes' cones that bound the hull at its nearest point, each times its share in
// the direction to the part (docs/error_budget.md). Held to redrawn rigs by hull_errors_test. Immutable.
// Thread: any.
class HullErrors {
 public:
  // Throws: PreconditionError: a covariance of another size; what RigErrors::Validate throws.
  HullErrors(const core::Rig& rig, core::RigErrors errors);

  [[nodiscard]] const core::RigErrors& errors() const { return errors_; }

  // At a point of the hull's surface, for the distance from there to `x_of_part`. Where the silhouettes near
  // the point don't explain the direction, as between a search's bounds, it is that of WorstAt.
  [[nodiscard]] core::ErrorBudget At(const VisualHull& hull, const Eigen::Vector3d& x_of_hull,
                                     const Eigen::Vector3d& x_of_part) const;

  // The same for a part that stands off a place of one camera's cone along the cone's normal there: its share
  // is 1, and no other silhouette counts. `is_located`: the silhouette's boundary is known between pixels.
  // All 0: the place isn't before the camera.
  [[nodiscard]] core::ErrorBudget OfCone(core::CameraIndex camera, const Eigen::Vector3d& normal_in_world,
                                         const Eigen::Vector3d& x_in_world, bool is_located) const;

  // The largest for one camera's cone in any direction, over the cameras that see the point. All 0: none
  // does.
  [[nodiscard]] core::ErrorBudget WorstAt(const Eigen::Vector3d& x_in_world) const;

  // The largest of WorstAt over a grid of 3 x 3 x 3 points of the box, each moved into the workspace. An
  // empty box: all 0.
  [[nodiscard]] core::ErrorBudget WorstIn(const Eigen::AlignedBox3d& box_in_world) const;

 private:
  struct Camera {
    core::CameraModel model;
    LensParameters lens;
    ParameterBlock parameters;
  };
  // A silhouette's cone that bounds the hull at a point, or a face of the workspace, which has no error.
  struct Bound {
    Eigen::Vector3d normal_in_world;  // unit, out of the hull
    Eigen::RowVectorXd shift_mm;      // of the cone along its normal, by all parameters: mm / unit of each
    double mm_per_px = 0.0;           // shift of the cone by a shift of the contour
    bool is_located = false;          // the silhouette's boundary is known between pixels
  };
  [[nodiscard]] std::vector<Bound> BoundsAt(const VisualHull& hull, const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] std::optional<Bound> BoundBy(std::size_t camera, const Eigen::Vector3d& normal_in_world,
                                             const Eigen::Vector3d& x_in_world) const;

  std::vector<Camera> cameras_;
  Eigen::AlignedBox3d workspace_mm_;
  core::RigErrors errors_;
};

}  // namespace elbowroom::recon
