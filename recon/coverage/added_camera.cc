#include "recon/coverage/added_camera.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"
#include "recon/calibration/pixel_response.h"

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

// Places at which the cameras' errors are looked at.
std::vector<Vector3d> PlacesIn(const Eigen::AlignedBox3d& box_mm) {
  constexpr double kFromMiddle = 0.35;  // of the box's sides
  std::vector<Vector3d> places_mm;
  for (int i = 0; i < 27; ++i) {
    const int column = i % 3 - 1, row = i / 3 % 3 - 1, layer = i / 9 - 1;
    places_mm.push_back(box_mm.center() +
                        kFromMiddle * box_mm.sizes().cwiseProduct(Vector3d(column, row, layer)));
  }
  return places_mm;
}

// The motion of the world's frame that explains best how the cameras' errors move triangulated points, as a
// function of these errors: 6 x the number of parameters. Zero: too few places are seen.
MatrixXd CommonMotion(const CalibratedRig& rig, const std::vector<Vector3d>& places_mm) {
  const Vector3d middle_mm = rig.rig.workspace_mm.center();
  const RigUncertainty uncertainty(rig.rig.cameras, rig.covariance, rig.noise_px);
  Matrix6d normal = Matrix6d::Zero();
  MatrixXd right = MatrixXd::Zero(6, rig.covariance.rows());
  int seen = 0;
  for (const Vector3d& x : places_mm) {
    const std::optional<Eigen::Matrix3Xd> shift = uncertainty.ShiftByParameters(x);
    if (!shift) continue;
    ++seen;
    Eigen::Matrix<double, 3, 6> by_motion;
    by_motion << -CrossMatrix(x - middle_mm), Matrix3d::Identity();
    normal += by_motion.transpose() * by_motion;
    right += by_motion.transpose() * *shift;
  }
  constexpr int kFewestPlaces = 8;
  if (seen < kFewestPlaces) return MatrixXd::Zero(6, rig.covariance.rows());
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

// By how much of an angle a camera's own error shifts what it sees: RMS over the places, in rad; 0 if it sees
// none.
double OwnSigmaRad(const core::CameraModel& camera, const MatrixXd& own_covariance,
                   const std::vector<Vector3d>& places_mm) {
  const LensParameters lens = LensParametersOf(camera.calibration());
  const core::RigidTransform& cam_from_world = camera.cam_from_world();
  double sum_px2 = 0.0;
  int seen = 0;
  for (const Vector3d& x : places_mm) {
    const std::optional<PixelResponse> response = PixelResponseAt(lens, cam_from_world, x);
    if (!response || !IsInPicture(camera, x)) continue;
    const Eigen::Matrix2Xd& by_own = response->by_parameters;
    sum_px2 += (by_own * own_covariance * by_own.transpose()).trace();
    ++seen;
  }
  return seen > 0 ? std::sqrt(sum_px2 / seen) / camera.calibration().camera_matrix(0, 0) : 0.0;
}

// The own error of a camera as that of one with the same lens at another pose. What a calibration knows well
// is where the place that a camera looks at falls in its picture; lens, turn and centre are known much worse,
// and make up for each other there. So the turn stays, and the shift of that place in the camera's frame
// grows with its distance.
void MoveTo(const core::RigidTransform& cam_from_world, const core::RigidTransform& like,
            const Vector3d& looked_at_mm, const ParameterBlock& block, MatrixXd* own) {
  const Vector3d before = like * looked_at_mm, after = cam_from_world * looked_at_mm;
  const double growth = after.norm() / before.norm();
  const MatrixXd turn = own->middleRows<3>(block.rotation() - block.first);
  auto shift = own->middleRows<3>(block.translation() - block.first);
  shift = growth * (shift - CrossMatrix(before) * turn) + CrossMatrix(after) * turn;
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

MatrixXd CovarianceWith(const CalibratedRig& rig, std::size_t like,
                        const core::RigidTransform& cam_from_world) {
  const std::vector<ParameterBlock> blocks = BlocksOf(rig.rig);
  const Eigen::Index count = rig.covariance.rows(), added = blocks[like].size();
  const Vector3d middle_mm = rig.rig.workspace_mm.center();
  const std::vector<Vector3d> places_mm = PlacesIn(rig.rig.workspace_mm);
  const MatrixXd common = CommonMotion(rig, places_mm);
  std::vector<double> sigmas_rad;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const MatrixXd own = OwnError(rig.rig.cameras[i], blocks[i], common, middle_mm);
    sigmas_rad.push_back(OwnSigmaRad(rig.rig.cameras[i], own * rig.covariance * own.transpose(), places_mm));
  }
  const double scale = sigmas_rad[like] > 0.0 ? MedianOf(sigmas_rad) / sigmas_rad[like] : 1.0;

  MatrixXd own = OwnError(rig.rig.cameras[like], blocks[like], common, middle_mm);
  MoveTo(cam_from_world, rig.rig.cameras[like].cam_from_world(), middle_mm, blocks[like], &own);
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
  if (rig.covariance.size() > 0) more.covariance = CovarianceWith(rig, like, cam_from_world);
  return more;
}

}  // namespace elbowroom::recon
