// How a triangulated point moves with its pixels and with the cameras' parameters.
#pragma once

#include <Eigen/Core>

#include "core/rigid_transform.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {

// With A the derivative of the point's pixels by the point and B that by the parameters, the point moves by
// A+ (noise - B d), for a small change d of the parameters.
class PointResponse {
 public:
  explicit PointResponse(int parameters) : by_parameters_(Eigen::Matrix3Xd::Zero(3, parameters)) {}

  // One camera that sees the point; does nothing if the point isn't before it.
  void Add(const LensParameters& lens, const core::RigidTransform& cam_from_world,
           const ParameterBlock& block, const Eigen::Vector3d& x_in_world);

  // After all cameras. False: they see the point from one direction alone.
  [[nodiscard]] bool Solve();

  // A+ A+^T: covariance of the point for pixels with variance 1, in mm^2 / px^2.
  [[nodiscard]] const Eigen::Matrix3d& by_noise() const { return by_noise_; }
  // -A+ B: 3 x parameters.
  [[nodiscard]] const Eigen::Matrix3Xd& by_parameters() const { return by_parameters_; }

 private:
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_noise_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd by_parameters_;
};

}  // namespace elbowroom::recon
