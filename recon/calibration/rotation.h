// Rotations as vectors: exponential, logarithm and their derivatives.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace elbowroom::recon {

// Hat(a) * b = a x b.
[[nodiscard]] inline Eigen::Matrix3d Hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d hat;
  hat << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return hat;
}

// The rotation by |w| radians about w.
[[nodiscard]] inline Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& w) {
  const double angle_rad = w.norm();
  if (angle_rad < 1e-10)
    return Eigen::Quaterniond(1.0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z()).normalized().toRotationMatrix();
  return Eigen::AngleAxisd(angle_rad, w / angle_rad).toRotationMatrix();
}

// Its inverse; the angle is at most pi.
[[nodiscard]] inline Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-10) return 2.0 * q.vec();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

// RotationFromVector(w + d) = RotationFromVector(w) * RotationFromVector(RightJacobian(w) * d), for small d
// (Sola et al., "A micro Lie theory", 2018).
[[nodiscard]] inline Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& w) {
  const double a = w.norm();
  const Eigen::Matrix3d hat = Hat(w);
  if (a < 1e-4) return Eigen::Matrix3d::Identity() - 0.5 * hat + hat * hat / 6.0;
  return Eigen::Matrix3d::Identity() - (1.0 - std::cos(a)) / (a * a) * hat +
         (a - std::sin(a)) / (a * a * a) * hat * hat;
}

// The inverse of RightJacobian; |w| < pi. That of the left Jacobian is its transpose.
[[nodiscard]] inline Eigen::Matrix3d InverseRightJacobian(const Eigen::Vector3d& w) {
  const double a = w.norm();
  const Eigen::Matrix3d hat = Hat(w);
  if (a < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * hat + hat * hat / 12.0;
  return Eigen::Matrix3d::Identity() + 0.5 * hat +
         (1.0 / (a * a) - (1.0 + std::cos(a)) / (2.0 * a * std::sin(a))) * hat * hat;
}

}  // namespace elbowroom::recon
