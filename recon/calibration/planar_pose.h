// Where a board stands, from the views of one instant.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

struct PosePoint {
  Eigen::Vector3d x_in_board;
  Eigen::Vector2d pixel;
  double inverse_sigma = 1.0;  // 1 / px
};

// What one camera sees of a board.
struct PosedView {
  const LensParameters* lens = nullptr;
  core::RigidTransform cam_from_rig;
  std::vector<PosePoint> points;
};

struct PoseFit {
  core::RigidTransform rig_from_board;
  double cost = 0.0;  // half the sum of losses; points behind a camera count as 1,000 px off
};

inline constexpr int kPoseSteps = 30;

// The minimum near `start` of the Cauchy loss (cauchy_scale in standard deviations; 0: plain squares).
[[nodiscard]] PoseFit FitBoardPose(std::span<const PosedView> views, const core::RigidTransform& start,
                                   double cauchy_scale, int most_steps = kPoseSteps);

// RMS of |residual| of one view in px, and the median of |residual|.
struct ViewError {
  double rms_px = 0.0;
  double median_px = 0.0;
};
[[nodiscard]] ViewError ErrorOf(const PosedView& view, const core::RigidTransform& rig_from_board);

struct PlanarPose {
  core::RigidTransform cam_from_board;
  ViewError error;
};

// Up to two poses that reproject a plane's points nearly alike (the flip; Collins and Bartoli, "Infinitesimal
// plane-based pose estimation", 2014), the better one first. One is the minimum near the homography's pose,
// the other that near its mirror image. Both show the printed side and are before the camera. Empty: fewer
// than four points, all points on one line, or no such pose. `normalised`: the points' positions without lens
// and camera matrix.
[[nodiscard]] std::vector<PlanarPose> PlanarPosesOf(const LensParameters& lens,
                                                    std::span<const PosePoint> points,
                                                    std::span<const Eigen::Vector2d> normalised,
                                                    int most_steps = kPoseSteps);

// Whether two fits ended in the same minimum: turned by less than a milliradian.
[[nodiscard]] bool AreOnePose(const core::RigidTransform& a, const core::RigidTransform& b);

// The printed side looks to the camera, and the point is before it.
[[nodiscard]] bool ShowsPrintedSide(const core::RigidTransform& cam_from_board,
                                    const Eigen::Vector3d& center_in_board);

// The pose with its normal mirrored at the line of sight to `center_in_board`: near to the other minimum.
[[nodiscard]] core::RigidTransform Flipped(const core::RigidTransform& cam_from_board,
                                           const Eigen::Vector3d& center_in_board);

}  // namespace elbowroom::recon
