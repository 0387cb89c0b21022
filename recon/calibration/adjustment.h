// Cameras, boards and views as the numbers that the bundle adjustment changes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/rigid_transform.h"
#include "recon/calibration/board_surface.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

// Frame `rig`: that of the fit; which one it is follows from what is fixed.
struct AdjustedCamera {
  LensParameters lens;
  core::RigidTransform cam_from_rig;
  double time_offset_s = 0.0;
  bool is_lens_fixed = false;
  bool is_pose_fixed = false;
  bool is_offset_fixed = true;
};

struct AdjustedBoard {
  core::RigidTransform rig_from_board;  // at time_s
  double time_s = 0.0;
  bool is_fixed = false;
};

struct AdjustedPoint {
  int point = 0;  // of the board, after the half turn if there is one
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double inverse_sigma = 1.0;  // 1 / px
  bool is_used = true;
};

// The board of the view's own instant, and up to two of other instants, by which the board moves.
struct AdjustedView {
  int camera = 0;
  std::array<int, 3> boards{};
  int board_count = 1;
  double time_s = 0.0;
  bool is_used = true;
  std::vector<AdjustedPoint> points;
};

// A stretch of the cameras' parameters.
struct ParameterRange {
  int first = 0;
  int count = 0;
};

[[nodiscard]] inline std::span<const int> BoardsOf(const AdjustedView& view) {
  return {view.boards.data(), static_cast<std::size_t>(view.board_count)};
}

struct Adjustment {
  const BoardSurface* surface = nullptr;
  Eigen::Vector3d flatness_mm = Eigen::Vector3d::Zero();
  bool is_flatness_fixed = true;
  std::vector<AdjustedCamera> cameras;
  // Two boards of one view are two places apart here at most (schur.h).
  std::vector<AdjustedBoard> boards;
  std::vector<AdjustedView> views;

  [[nodiscard]] ParameterBlock BlockOf(int camera) const;
  [[nodiscard]] int camera_parameters() const;  // of all blocks, and of the flatness behind them
  [[nodiscard]] std::vector<ParameterRange> kept_parameters() const;  // of these, what stays as it is
};

// How the board stands in the rig at the instant of the view. The board's position and its turn from its own
// instant follow the parabola through the instants of the view's boards, so that the error is of the third
// order in the time between them.
[[nodiscard]] core::RigidTransform RigFromBoardAt(const Adjustment& adjustment, const AdjustedView& view);
[[nodiscard]] core::RigidTransform CamFromBoardAt(const Adjustment& adjustment, const AdjustedView& view);

// Derivatives of cam_from_board for a change that turns and moves the board in the camera's frame: (turn
// about the camera's centre, translation). Columns: the camera's rotation and translation, its time offset,
// then for each of the view's boards the turn from the right and the translation.
struct MovedBoard {
  core::RigidTransform cam_from_board;
  Eigen::Matrix<double, 6, 6> by_camera;
  Eigen::Matrix<double, 6, 1> by_time_s;
  std::array<Eigen::Matrix<double, 6, 6>, 3> by_board;
};
[[nodiscard]] MovedBoard DifferentiateMotion(const Adjustment& adjustment, const AdjustedView& view);

// Model minus seen, in px; nothing: the point isn't before the camera.
[[nodiscard]] std::optional<Eigen::Vector2d> ResidualOf(const Adjustment& adjustment,
                                                        const AdjustedView& view,
                                                        const core::RigidTransform& cam_from_board,
                                                        const AdjustedPoint& point);

// A step of all parameters: camera_parameters() entries, then six for each board.
[[nodiscard]] Adjustment Moved(const Adjustment& adjustment, const Eigen::VectorXd& step);

}  // namespace elbowroom::recon
