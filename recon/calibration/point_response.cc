#include "recon/calibration/point_response.h"

#include <Eigen/LU>

#include "recon/calibration/pixel_response.h"

namespace elbowroom::recon {

void PointResponse::Add(const LensParameters& lens, const core::RigidTransform& cam_from_world,
                        const ParameterBlock& block, const Eigen::Vector3d& x_in_world) {
  const auto pixel = PixelResponseAt(lens, cam_from_world, x_in_world);
  if (!pixel) return;
  const Eigen::Matrix<double, 2, 3>& by_x = pixel->by_x_in_world;
  normal_ += by_x.transpose() * by_x;
  by_parameters_.middleCols(block.first, block.size()) = -by_x.transpose() * pixel->by_parameters;  // -A^T B
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
