#include "recon/boards/homography.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

// Moves the centroid to the origin and the mean distance from it to sqrt(2).
Matrix3d Normaliser(const std::vector<PointPair>& pairs, Vector2d PointPair::*end) {
  Vector2d mean = Vector2d::Zero();
  for (const PointPair& pair : pairs) mean += pair.*end;
  mean /= static_cast<double>(pairs.size());
  double distance = 0.0;
  for (const PointPair& pair : pairs) distance += (pair.*end - mean).norm();
  const double scale = std::numbers::sqrt2 * static_cast<double>(pairs.size()) / std::max(distance, 1e-12);
  Matrix3d normalise;
  normalise << scale, 0.0, -scale * mean.x(), 0.0, scale, -scale * mean.y(), 0.0, 0.0, 1.0;
  return normalise;
}

}  // namespace

std::optional<Matrix3d> FitHomography(const std::vector<PointPair>& pairs) {
  if (pairs.size() < 4) return std::nullopt;
  const Matrix3d from_normaliser = Normaliser(pairs, &PointPair::from);
  const Matrix3d to_normaliser = Normaliser(pairs, &PointPair::to);
  // Each pair gives two rows a with a h = 0, where h lists the homography's rows; h minimises |A h|, |h| = 1.
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d p = from_normaliser * pair.from.homogeneous();
    const Vector2d q = (to_normaliser * pair.to.homogeneous()).head<2>();
    Eigen::Matrix<double, 9, 1> a, b;
    a << p, Eigen::Vector3d::Zero(), -q.x() * p;
    b << Eigen::Vector3d::Zero(), p, -q.y() * p;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(a);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(b);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
  if (solver.info() != Eigen::Success) return std::nullopt;
  // Points on a line leave more than one solution.
  const auto& values = solver.eigenvalues();
  if (!(values[1] > 1e-9 * values[8])) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  Matrix3d normalised;
  normalised << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  const Matrix3d homography = to_normaliser.inverse() * normalised * from_normaliser;
  if (!homography.allFinite() || !(std::abs(normalised.determinant()) > 1e-9)) return std::nullopt;
  return homography;
}

Eigen::Matrix2d MapDerivative(const Matrix3d& to_from_from, const Vector2d& x) {
  const Eigen::Vector3d y = to_from_from * x.homogeneous();
  const Vector2d mapped = y.hnormalized();
  return (to_from_from.topLeftCorner<2, 2>() - mapped * to_from_from.bottomLeftCorner<1, 2>()) / y.z();
}

}  // namespace elbowroom::recon
