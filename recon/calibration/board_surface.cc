#include "recon/calibration/board_surface.h"

#include <Eigen/QR>

namespace elbowroom::recon {

BoardSurface::BoardSurface(const Board& board) : flat_(PointsOf(board)) {
  const auto count = static_cast<Eigen::Index>(flat_.size());
  Eigen::Vector3d low = flat_.front(), high = flat_.front();
  for (const Eigen::Vector3d& x : flat_) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  center_ = 0.5 * (low + high);
  diagonal_mm_ = (high - low).norm();

  Eigen::MatrixXd plane(count, 3), quadratic(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d x = (flat_[static_cast<std::size_t>(i)] - center_) / (0.5 * diagonal_mm_);
    plane.row(i) << 1.0, x.x(), x.y();
    quadratic.row(i) << x.x() * x.x(), x.x() * x.y(), x.y() * x.y();
  }
  const Eigen::MatrixXd rest = quadratic - plane * plane.colPivHouseholderQr().solve(quadratic);
  // Fewer than three points across leave one of the terms without a part of its own.
  constexpr double kLeastBending = 1e-3;
  can_bend_ = count >= 9 && rest.cwiseAbs().colwise().maxCoeff().minCoeff() > kLeastBending;
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Vector3d bending = Eigen::Vector3d::Zero();
    if (can_bend_)
      bending = rest.row(i).transpose().cwiseQuotient(rest.cwiseAbs().colwise().maxCoeff().transpose());
    bending_.push_back(bending);
  }
  if (!PointAfterHalfTurn(board, 0)) return;
  for (int i = 0; i < points(); ++i) half_turn_.push_back(PointAfterHalfTurn(board, i).value_or(i));
}

core::RigidTransform BoardSurface::HalfTurn() const {
  const Eigen::Matrix3d turn = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  return {turn, center_ - turn * center_};
}

bool BoardSurface::HasFirstCornerFirst(const core::RigidTransform& cam_from_board) const {
  const auto sum_of = [&](const Eigen::Vector3d& x_in_board) {
    const Eigen::Vector3d x = cam_from_board * x_in_board;
    return x.x() / x.z() + x.y() / x.z();
  };
  return sum_of(flat_.front()) <= sum_of(flat_.back());
}

}  // namespace elbowroom::recon
