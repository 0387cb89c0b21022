#include "app/control/placing/rigid_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace elbowroom::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kOnALine = 1e-6;  // of the points' extent

// Root mean square distances from the longest line through points, and along it.
struct PointSpread {
  double across_mm = 0.0;
  double along_mm = 0.0;
};

PointSpread SpreadOf(const Matrix3d& covariance) {
  const Vector3d squares = Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvalues().cwiseMax(0.0);
  return {std::sqrt(squares[0] + squares[1]), std::sqrt(squares[2])};
}

}  // namespace

RigidFit FitRigid(const std::vector<PointPair>& pairs) {
  if (pairs.size() < 3)
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("{} points: where a part stands takes three at least", pairs.size()));
  const double count = static_cast<double>(pairs.size());
  Vector3d part_center = Vector3d::Zero(), world_center = Vector3d::Zero();
  for (const PointPair& pair : pairs) {
    part_center += pair.x_in_part / count;
    world_center += pair.x_in_world / count;
  }
  Matrix3d cross = Matrix3d::Zero(), part_square = Matrix3d::Zero(), world_square = Matrix3d::Zero();
  for (const PointPair& pair : pairs) {
    const Vector3d p = pair.x_in_part - part_center, w = pair.x_in_world - world_center;
    cross += w * p.transpose() / count;
    part_square += p * p.transpose() / count;
    world_square += w * w.transpose() / count;
  }
  const PointSpread part_spread = SpreadOf(part_square), world_spread = SpreadOf(world_square);
  for (const PointSpread& spread : {part_spread, world_spread})
    if (!(spread.across_mm > kOnALine * spread.along_mm))
      throw core::Error(core::ErrorKind::kRange,
                        "the points lie on one line: measure one that is well beside it, too");
  // R maximises the trace of R^T cross; U V^T does, but for its sign, which would be a mirror.
  const Eigen::JacobiSVD<Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  RigidFit fit;
  fit.world_from_part.rotation =
      svd.matrixU() * Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  fit.world_from_part.translation_mm = world_center - fit.world_from_part.rotation * part_center;
  fit.spread_mm = std::min(part_spread.across_mm, world_spread.across_mm);
  double squares = 0.0;
  for (const PointPair& pair : pairs) {
    fit.residuals_mm.push_back((fit.world_from_part * pair.x_in_part - pair.x_in_world).norm());
    squares += fit.residuals_mm.back() * fit.residuals_mm.back();
  }
  fit.rms_mm = std::sqrt(squares / count);
  fit.largest_mm = *std::ranges::max_element(fit.residuals_mm);
  return fit;
}

}  // namespace elbowroom::control
