#include "recon/calibration/calibration_result.h"

#include <cmath>

#include "core/error.h"
#include "recon/calibration/rotation.h"

namespace elbowroom::recon {
namespace {

const CalibratedCamera& CameraOf(const CalibrationResult& result, int camera) {
  core::Require(camera >= 0 && camera < static_cast<int>(result.cameras.size()),
                "the camera is one of the result's");
  return result.cameras[static_cast<std::size_t>(camera)];
}

}  // namespace

Eigen::Matrix3d CenterCovariance(const CalibrationResult& result, int camera) {
  const CalibratedCamera& c = CameraOf(result, camera);
  const core::RigidTransform& cam_from_world = c.calibration.cam_from_world;
  // The centre is -R^T t. With R turned by w from the left it moves by -R^T (dt + [t]x w).
  const Eigen::Matrix3d world_from_cam = cam_from_world.rotation.transpose();
  Eigen::Matrix<double, 3, 6> by_pose;
  by_pose << -world_from_cam * Hat(cam_from_world.translation_mm), -world_from_cam;
  return by_pose * result.covariance.block<6, 6>(c.parameters.rotation(), c.parameters.rotation()) *
         by_pose.transpose();
}

Eigen::Matrix3d RotationCovariance(const CalibrationResult& result, int camera) {
  const int at = CameraOf(result, camera).parameters.rotation();
  return result.covariance.block<3, 3>(at, at);
}

double CenterSigmaMm(const CalibrationResult& result, int camera) {
  return std::sqrt(CenterCovariance(result, camera).trace());
}

double RotationSigmaRad(const CalibrationResult& result, int camera) {
  return std::sqrt(RotationCovariance(result, camera).trace());
}

}  // namespace elbowroom::recon
