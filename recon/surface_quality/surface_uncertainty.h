// How far the hull's surface may be off, at each place of it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/rig.h"
#include "core/rig_quality.h"
#include "core/rigid_transform.h"
#include "recon/error_budget/hull_errors.h"
#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull_declared.h"
#include "recon/surface_quality/surface_values.h"

namespace elbowroom::recon {

// U = 2 sigma of docs/error_budget.md, mm, of the distance to a part that stands off the surface along its
// normal: calibration, and footprint or segmentation, of the camera whose silhouette bounds the hull there
// (HullErrors::OfCone). Looked up in a table over each camera's picture, which is made once a rig: exact in
// depth, off by less than 0.2 % between its nodes; where a lens folds, worked out (surface_uncertainty_test).
// The skew of cameras at other instants isn't in it. Immutable. Thread: any.
class SurfaceUncertainty {
 public:
  // Throws: as HullErrors.
  SurfaceUncertainty(const core::Rig& rig, core::RigErrors errors);

  // `normal_in_world`: unit, across the camera's line of sight. 0: the place isn't before the camera.
  [[nodiscard]] double ExpandedMm(core::CameraIndex camera, const Eigen::Vector3d& normal_in_world,
                                  const Eigen::Vector3d& x_in_world, bool is_located) const;
  // Of a hull of this rig; the picture has surfaces and normals. Throws: PreconditionError: it hasn't, or its
  // size isn't that of `rays`.
  [[nodiscard]] SurfaceValues Of(const VisualHull& hull, const HullView& picture, const ViewRays& rays) const;

  [[nodiscard]] const HullErrors& errors() const { return errors_; }

 private:
  // What one ray of a camera gives. With X/Z, Y/Z = u, v, J the derivative of the pixel by (u, v), and 1/Z =
  // q: inverse_transposed = J^-T; the pixel's covariance by the parameters' is covariance[0] + [1] q + [2]
  // q^2.
  struct Node {
    Eigen::Matrix2d inverse_transposed;
    std::array<Eigen::Matrix2d, 3> covariance_px2;
  };
  struct Table {
    core::RigidTransform cam_from_world;
    Eigen::Vector2d first;        // (u, v) of the first node
    Eigen::Vector2d step;         // between two
    std::vector<Node> nodes;      // kNodes x kNodes, row by row
    std::vector<bool> is_usable;  // likewise
  };
  static constexpr int kNodes = 33;

  [[nodiscard]] static Table TableOf(const core::CameraModel& camera, const Eigen::MatrixXd& covariance,
                                     double distance_mm);
  [[nodiscard]] static std::optional<Node> NodeAt(const Table& table, const Eigen::Vector2d& uv);

  HullErrors errors_;
  std::vector<Table> tables_;
};

}  // namespace elbowroom::recon
