#include "recon/calibration/adjustment.h"

#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

using core::RigidTransform;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const AdjustedCamera& CameraOfView(const Adjustment& a, const AdjustedView& view) {
  return a.cameras[static_cast<std::size_t>(view.camera)];
}

const AdjustedBoard& BoardOfView(const Adjustment& a, const AdjustedView& view, int i) {
  return a.boards[static_cast<std::size_t>(view.boards[static_cast<std::size_t>(i)])];
}

// Lagrange's polynomials through the instants of the view's boards, and their slopes, at the view's instant.
struct TimeWeights {
  std::array<double, 3> value{1.0, 0.0, 0.0};
  std::array<double, 3> slope_per_s{};
};

TimeWeights WeightsAt(const Adjustment& a, const AdjustedView& view) {
  TimeWeights weights;
  if (view.board_count == 1) return weights;
  const double t = view.time_s + CameraOfView(a, view).time_offset_s;
  for (int i = 0; i < view.board_count; ++i) {
    double value = 1.0, slope = 0.0;
    for (int j = 0; j < view.board_count; ++j) {
      if (j == i) continue;
      const double span_s = BoardOfView(a, view, i).time_s - BoardOfView(a, view, j).time_s;
      const double factor = (t - BoardOfView(a, view, j).time_s) / span_s;
      slope = slope * factor + value / span_s;
      value *= factor;
    }
    weights.value[static_cast<std::size_t>(i)] = value;
    weights.slope_per_s[static_cast<std::size_t>(i)] = slope;
  }
  return weights;
}

// The turn from the view's own board to each of its others, as vectors in the own board's frame.
std::array<Vector3d, 3> TurnsFromOwn(const Adjustment& a, const AdjustedView& view) {
  std::array<Vector3d, 3> turns{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const Matrix3d own_from_rig = BoardOfView(a, view, 0).rig_from_board.rotation.transpose();
  for (int i = 1; i < view.board_count; ++i)
    turns[static_cast<std::size_t>(i)] =
        VectorFromRotation(own_from_rig * BoardOfView(a, view, i).rig_from_board.rotation);
  return turns;
}

}  // namespace

ParameterBlock Adjustment::BlockOf(int camera) const {
  ParameterBlock block;
  for (int i = 0; i < camera; ++i) block.first += cameras[static_cast<std::size_t>(i)].lens.count() + 7;
  block.intrinsics = cameras[static_cast<std::size_t>(camera)].lens.count();
  return block;
}

int Adjustment::camera_parameters() const {
  const ParameterBlock last = BlockOf(static_cast<int>(cameras.size()) - 1);
  return last.first + last.size() + kFlatnessTerms;
}

std::vector<ParameterRange> Adjustment::kept_parameters() const {
  std::vector<ParameterRange> kept;
  for (int i = 0; i < static_cast<int>(cameras.size()); ++i) {
    const AdjustedCamera& camera = cameras[static_cast<std::size_t>(i)];
    const ParameterBlock block = BlockOf(i);
    if (camera.is_lens_fixed) kept.push_back({block.first, block.intrinsics});
    if (camera.is_pose_fixed) kept.push_back({block.rotation(), 6});
    if (camera.is_offset_fixed) kept.push_back({block.time_offset(), 1});
  }
  if (is_flatness_fixed) kept.push_back({camera_parameters() - kFlatnessTerms, kFlatnessTerms});
  return kept;
}

RigidTransform RigFromBoardAt(const Adjustment& a, const AdjustedView& view) {
  const RigidTransform& own = BoardOfView(a, view, 0).rig_from_board;
  if (view.board_count == 1) return own;
  const TimeWeights weights = WeightsAt(a, view);
  const std::array<Vector3d, 3> turns = TurnsFromOwn(a, view);
  Vector3d turn = Vector3d::Zero(), position_mm = Vector3d::Zero();
  for (int i = 0; i < view.board_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    turn += weights.value[at] * turns[at];
    position_mm += weights.value[at] * BoardOfView(a, view, i).rig_from_board.translation_mm;
  }
  return {own.rotation * RotationFromVector(turn), position_mm};
}

RigidTransform CamFromBoardAt(const Adjustment& a, const AdjustedView& view) {
  return CameraOfView(a, view).cam_from_rig * RigFromBoardAt(a, view);
}

MovedBoard DifferentiateMotion(const Adjustment& a, const AdjustedView& view) {
  const RigidTransform& cam_from_rig = CameraOfView(a, view).cam_from_rig;
  const RigidTransform rig_from_board = RigFromBoardAt(a, view);
  MovedBoard moved;
  moved.cam_from_board = cam_from_rig * rig_from_board;
  // A turn w of the camera is about the camera frame's origin after its translation t:
  // x + w x (x - t) + dt = x + w x x + (dt + t x w).
  moved.by_camera.setIdentity();
  moved.by_camera.bottomLeftCorner<3, 3>() = Hat(cam_from_rig.translation_mm);
  // The same for a turn of the board from the right, which is about the board's origin.
  Eigen::Matrix<double, 6, 6> by_board_now;
  by_board_now.setZero();
  by_board_now.topLeftCorner<3, 3>() = moved.cam_from_board.rotation;
  by_board_now.bottomLeftCorner<3, 3>() =
      Hat(moved.cam_from_board.translation_mm) * moved.cam_from_board.rotation;
  by_board_now.bottomRightCorner<3, 3>() = cam_from_rig.rotation;
  moved.by_time_s.setZero();
  if (view.board_count == 1) {
    moved.by_board[0] = by_board_now;
    return moved;
  }

  const TimeWeights weights = WeightsAt(a, view);
  const std::array<Vector3d, 3> turns = TurnsFromOwn(a, view);
  Vector3d turn = Vector3d::Zero(), turn_per_s = Vector3d::Zero(), velocity = Vector3d::Zero();
  for (int i = 0; i < view.board_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    turn += weights.value[at] * turns[at];
    turn_per_s += weights.slope_per_s[at] * turns[at];
    velocity += weights.slope_per_s[at] * BoardOfView(a, view, i).rig_from_board.translation_mm;
  }
  const Matrix3d right = RightJacobian(turn);
  // With the own board turned by w0 and another by w1, log(R0^T R1) changes by J^-1 w1 - J^-T w0.
  Matrix3d by_own_turn = RotationFromVector(turn).transpose();
  for (int i = 0; i < view.board_count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    Eigen::Matrix<double, 6, 6> now_by_board;
    now_by_board.setZero();
    now_by_board.bottomRightCorner<3, 3>() = weights.value[at] * Matrix3d::Identity();
    if (i > 0) {
      const Matrix3d inverse = InverseRightJacobian(turns[at]);
      now_by_board.topLeftCorner<3, 3>() = right * (weights.value[at] * inverse);
      by_own_turn -= right * (weights.value[at] * inverse.transpose());
    }
    moved.by_board[at] = by_board_now * now_by_board;
  }
  Eigen::Matrix<double, 6, 3> own_turn_now;
  own_turn_now << by_own_turn, Matrix3d::Zero();
  moved.by_board[0].leftCols<3>() = by_board_now * own_turn_now;
  Eigen::Matrix<double, 6, 1> per_s;
  per_s << right * turn_per_s, velocity;
  moved.by_time_s = by_board_now * per_s;
  return moved;
}

std::optional<Eigen::Vector2d> ResidualOf(const Adjustment& a, const AdjustedView& view,
                                          const RigidTransform& cam_from_board, const AdjustedPoint& point) {
  const Vector3d x_in_board = a.surface->Bent(point.point, a.flatness_mm);
  const std::optional<Eigen::Vector2d> pixel =
      ProjectPoint(CameraOfView(a, view).lens, cam_from_board * x_in_board);
  if (!pixel) return std::nullopt;
  return *pixel - point.pixel;
}

Adjustment Moved(const Adjustment& adjustment, const Eigen::VectorXd& step) {
  Adjustment moved = adjustment;
  int at = 0;
  for (AdjustedCamera& camera : moved.cameras) {
    const int intrinsics = camera.lens.count();
    camera.lens.values += step.segment(at, intrinsics);
    camera.cam_from_rig.rotation =
        RotationFromVector(step.segment<3>(at + intrinsics)) * camera.cam_from_rig.rotation;
    camera.cam_from_rig.translation_mm += step.segment<3>(at + intrinsics + 3);
    camera.time_offset_s += step[at + intrinsics + 6];
    at += intrinsics + 7;
  }
  moved.flatness_mm += step.segment<3>(at);
  at += kFlatnessTerms;
  for (AdjustedBoard& board : moved.boards) {
    board.rig_from_board.rotation *= RotationFromVector(step.segment<3>(at));
    board.rig_from_board.translation_mm += step.segment<3>(at + 3);
    at += 6;
  }
  return moved;
}

}  // namespace elbowroom::recon
