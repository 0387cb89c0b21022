#include "recon/calibration/point_response.h"

#include <Eigen/LU>

#include "recon/calibration/rotation.h"

namespace elbowroom::recon {

void PointResponse::Add(const LensParameters& lens, const core::RigidTransform& cam_from_world,
                        const ParameterBlock& block, const Eigen::Vector3d& x_in_world) {
  const Eigen::Vector3d turned = cam_from_world.rotation * x_in_world;
  const auto projected = ProjectWithDerivatives(lens, turned + cam_from_world.translation_mm);
  if (!projected) return;
  const Eigen::Matrix<double, 2, 3> by_x = projected->by_x_in_cam * cam_from_world.rotation;
  normal_ += by_x.transpose() * by_x;
  // Minus A^T B, block by block; a turn w of the camera moves the point in its frame by w x turned.
  const Eigen::Matrix<double, 3, 2> minus = -by_x.transpose();
  by_parameters_.middleCols(block.first, block.intrinsics) = minus * projected->by_values;
  by_parameters_.middleCols<3>(block.rotation()) = minus * (-projected->by_x_in_cam * Hat(turned));
  by_parameters_.middleCols<3>(block.translation()) = minus * projected->by_x_in_cam;
}

bool PointResponse::Solve() {
  // The determinant over the mean eigenvalue cubed is small when one direction isn't seen.
  constexpr double kLeastDeterminant = 1e-9;
  const double mean = normal_.trace() / 3.0;
  if (!(normal_.determinant() > kLeastDeterminant * mean * mean * mean)) return false;
  by_noise_ = normal_.inverse();
  by_parameters_ = by_noise_ * by_parameters_;
  return true;
}

}  // namespace elbowroom::recon
