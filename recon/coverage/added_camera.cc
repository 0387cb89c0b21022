#include "recon/coverage/added_camera.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Matrix3d CrossMatrix(const Vector3d& v) {
  return (Matrix3d() << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0).finished();
}

std::vector<ParameterBlock> BlocksOf(const core::Rig& rig) {
  std::vector<ParameterBlock> blocks;
  int first = 0;
  for (const core::CameraModel& camera : rig.cameras) {
    blocks.push_back({first, LensParametersOf(camera.calibration()).count()});
    first += blocks.back().size();
  }
  return blocks;
}

// How a small motion of the world's frame, x -> x + turn x (x - middle) + shift, changes a camera's rotation
// and translation parameters; columns: turn, shift.
Matrix6d ByWorldMotion(const core::RigidTransform& cam_from_world, const Vector3d& middle_mm) {
  const Matrix3d& r = cam_from_world.rotation;
  Matrix6d by_motion = Matrix6d::Zero();
  by_motion.topLeftCorner<3, 3>() = -r;
  by_motion.bottomLeftCorner<3, 3>() = -r * CrossMatrix(middle_mm);
  by_motion.bottomRightCorner<3, 3>() = -r;
  return by_motion;
}

// A camera's turn, times `arm_mm`, and the shift of its centre, both along the world's axes and in mm, by its
// rotation and translation parameters.
Matrix6d ToTurnAndShift(const core::RigidTransform& cam_from_world, double arm_mm) {
  const Matrix3d back = cam_from_world.rotation.transpose();
  Matrix6d to = Matrix6d::Zero();
  to.topLeftCorner<3, 3>() = arm_mm * back;
  to.bottomLeftCorner<3, 3>() = -back * CrossMatrix(cam_from_world.translation_mm);
  to.bottomRightCorner<3, 3>() = -back;
  return to;
}

// The motion of the world's frame that explains the cameras' errors best, as a function of these: 6 x the
// number of parameters.
MatrixXd CommonMotion(const core::Rig& rig, const std::vector<ParameterBlock>& blocks,
                      Eigen::Index parameters, const Vector3d& middle_mm) {
  double arm_mm = 0.0;
  for (const core::CameraModel& camera : rig.cameras)
    arm_mm += (camera.center_in_world() - middle_mm).norm() / static_cast<double>(rig.cameras.size());
  Matrix6d normal = Matrix6d::Zero();
  MatrixXd right = MatrixXd::Zero(6, parameters);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const core::RigidTransform& cam_from_world = rig.cameras[i].cam_from_world();
    const Matrix6d observed = ToTurnAndShift(cam_from_world, arm_mm);
    const Matrix6d model = observed * ByWorldMotion(cam_from_world, middle_mm);
    normal += model.transpose() * model;
    right.middleCols<6>(blocks[i].rotation()) = model.transpose() * observed;
  }
  return normal.ldlt().solve(right);
}

// What is left of a camera's parameters after the common motion, as a function of all parameters.
MatrixXd OwnError(const core::CameraModel& camera, const ParameterBlock& block, const MatrixXd& common,
                  const Vector3d& middle_mm) {
  MatrixXd own = MatrixXd::Zero(block.size(), common.cols());
  own.middleCols(block.first, block.size()).setIdentity();
  own.middleRows<6>(block.intrinsics) -= ByWorldMotion(camera.cam_from_world(), middle_mm) * common;
  return own;
}

double OwnSigmaMm(const core::CameraModel& camera, const ParameterBlock& block, const MatrixXd& own,
                  const MatrixXd& covariance) {
  const Eigen::Matrix<double, 3, Eigen::Dynamic> shift =
      ToTurnAndShift(camera.cam_from_world(), 1.0).bottomRows<3>() * own.middleRows<6>(block.intrinsics);
  return std::sqrt(std::max((shift * covariance * shift.transpose()).trace(), 0.0));
}

// The own error of camera `like` as that of a camera at another pose: the turn and the shift of the centre
// stay the same along the camera's axes.
void MoveTo(const core::RigidTransform& cam_from_world, const core::RigidTransform& like,
            const ParameterBlock& block, MatrixXd* own) {
  own->middleRows<3>(block.intrinsics + 3) +=
      CrossMatrix(like.translation_mm - cam_from_world.translation_mm) * own->middleRows<3>(block.intrinsics);
}

MatrixXd WithBlock(const CalibratedRig& rig, std::size_t like, const core::RigidTransform& cam_from_world) {
  const std::vector<ParameterBlock> blocks = BlocksOf(rig.rig);
  const Eigen::Index count = rig.covariance.rows(), added = blocks[like].size();
  const Vector3d middle_mm = rig.rig.workspace_mm.center();
  const bool has_common = rig.rig.cameras.size() > 1;  // one camera's error is all its own
  const MatrixXd common =
      has_common ? CommonMotion(rig.rig, blocks, count, middle_mm) : MatrixXd::Zero(6, count);
  std::vector<double> sigmas_mm;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    sigmas_mm.push_back(OwnSigmaMm(rig.rig.cameras[i], blocks[i],
                                   OwnError(rig.rig.cameras[i], blocks[i], common, middle_mm),
                                   rig.covariance));
  const double of_like_mm = sigmas_mm[like];
  std::ranges::nth_element(sigmas_mm, sigmas_mm.begin() + static_cast<std::ptrdiff_t>(sigmas_mm.size() / 2));
  double scale = of_like_mm > 0.0 ? sigmas_mm[sigmas_mm.size() / 2] / of_like_mm : 1.0;
  // The fit of the common motion takes its share of the own errors away.
  const auto cameras = static_cast<double>(blocks.size());
  if (has_common) scale *= std::sqrt(cameras / (cameras - 1.0));

  MatrixXd own = OwnError(rig.rig.cameras[like], blocks[like], common, middle_mm);
  MoveTo(cam_from_world, rig.rig.cameras[like].cam_from_world(), blocks[like], &own);
  MatrixXd shared = MatrixXd::Zero(added, count);
  shared.middleRows<6>(blocks[like].intrinsics) = ByWorldMotion(cam_from_world, middle_mm) * common;
  MatrixXd covariance(count + added, count + added);
  covariance.topLeftCorner(count, count) = rig.covariance;
  covariance.bottomLeftCorner(added, count) = shared * rig.covariance;
  covariance.topRightCorner(count, added) = covariance.bottomLeftCorner(added, count).transpose();
  covariance.bottomRightCorner(added, added) =
      shared * rig.covariance * shared.transpose() + scale * scale * (own * rig.covariance * own.transpose());
  return covariance;
}

}  // namespace

CalibratedRig WithCamera(const CalibratedRig& rig, std::size_t like,
                         const core::RigidTransform& cam_from_world) {
  CalibratedRig more = rig;
  core::CameraCalibration camera = rig.rig.cameras[like].calibration();
  camera.name = "next";
  camera.cam_from_world = cam_from_world;
  more.rig.cameras.emplace_back(std::move(camera));
  if (rig.covariance.size() > 0) more.covariance = WithBlock(rig, like, cam_from_world);
  return more;
}

}  // namespace elbowroom::recon
