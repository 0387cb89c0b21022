// The pairs of a rig's cameras, and the angle that names each epipolar plane of a pair.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/rig.h"
#include "recon/contours/undistorted_plane.h"

namespace elbowroom::recon {

// Two cameras. An epipolar plane is a half-plane from the line through both centres; its angle about that
// line is 0 towards the middle of the workspace.
//
// Frames: `axis`, `zero` and `quarter` are unit vectors in world, right-handed in the order zero, quarter,
// axis.
struct EpipolarPair {
  core::CameraIndex a = 0, b = 0;                   // a < b
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // from a's centre to b's
  Eigen::Vector3d zero = Eigen::Vector3d::UnitX();  // where the angle is 0
  Eigen::Vector3d quarter = Eigen::Vector3d::UnitY();
  // Rows: zero and quarter, in each camera's frame.
  Eigen::Matrix<double, 2, 3> from_a = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> from_b = Eigen::Matrix<double, 2, 3>::Zero();
  double baseline_mm = 0.0;

  [[nodiscard]] const Eigen::Matrix<double, 2, 3>& From(core::CameraIndex camera) const {
    return camera == a ? from_a : from_b;
  }
};

// A rig with all that its tangents need, worked out once. Immutable. Thread: any.
class EpipolarPairs {
 public:
  // Cameras whose centres are nearer than 1 mm to each other make no pair. Throws: PreconditionError when
  // there isn't one plane a camera.
  EpipolarPairs(const core::Rig& rig, UndistortedPlanes planes);

  [[nodiscard]] std::size_t camera_count() const { return planes_.size(); }
  // (0, 1), (0, 2), ... (1, 2), ...
  [[nodiscard]] const std::vector<EpipolarPair>& pairs() const { return pairs_; }
  [[nodiscard]] const UndistortedPlane& plane(core::CameraIndex camera) const { return *planes_[camera]; }

  [[nodiscard]] const Eigen::AlignedBox3d& workspace_mm() const { return workspace_mm_; }

  // Whether the camera's picture, less a margin, holds all of what a sight has in the workspace; false where
  // the sight misses the workspace. `sight`: unit, in world.
  [[nodiscard]] bool SeesSight(core::CameraIndex camera, const Eigen::Vector3d& from_in_world,
                               const Eigen::Vector3d& sight, double margin_px) const;

 private:
  Eigen::AlignedBox3d workspace_mm_;
  UndistortedPlanes planes_;
  std::vector<EpipolarPair> pairs_;
};

// Whether the pixel is in the picture, and at least the margin from its border.
[[nodiscard]] bool IsWithin(const core::CameraModel& camera, const Eigen::Vector2d& pixel, double margin_px);

}  // namespace elbowroom::recon
