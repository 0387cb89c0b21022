#include "recon/calibration/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace elbowroom::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The point nearest to all rays.
std::optional<Vector3d> NearestToRays(std::span<const PointSight> sights) {
  constexpr double kLeastAngleRad = 1e-4;
  Matrix3d sum = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const PointSight& sight : sights) {
    const auto normalised = NormalisedPoint(*sight.lens, sight.pixel);
    if (!normalised) continue;
    const core::RigidTransform world_from_cam = sight.cam_from_world.Inverse();
    const Vector3d ray = (world_from_cam.rotation * normalised->homogeneous()).normalized();
    const Matrix3d across = Matrix3d::Identity() - ray * ray.transpose();
    sum += across;
    right += across * world_from_cam.translation_mm;
  }
  const Eigen::LDLT<Matrix3d> factors(sum);
  if (!(factors.vectorD().minCoeff() > kLeastAngleRad * kLeastAngleRad)) return std::nullopt;
  return factors.solve(right);
}

}  // namespace

std::optional<Vector3d> Triangulate(std::span<const PointSight> sights) {
  if (sights.size() < 2) return std::nullopt;
  std::optional<Vector3d> x = NearestToRays(sights);
  constexpr int kSteps = 10;
  constexpr double kSettledMm = 1e-9;
  for (int step = 0; x && step < kSteps; ++step) {
    Matrix3d matrix = Matrix3d::Zero();
    Vector3d gradient = Vector3d::Zero();
    for (const PointSight& sight : sights) {
      const auto projected = ProjectWithDerivatives(*sight.lens, sight.cam_from_world * *x);
      if (!projected) return std::nullopt;
      const Eigen::Matrix<double, 2, 3> by_x = projected->by_x_in_cam * sight.cam_from_world.rotation;
      matrix += by_x.transpose() * by_x;
      gradient -= by_x.transpose() * (projected->pixel - sight.pixel);
    }
    const Vector3d change = matrix.ldlt().solve(gradient);
    if (!change.allFinite()) return std::nullopt;
    *x += change;
    if (change.norm() < kSettledMm) break;
  }
  return x;
}

}  // namespace elbowroom::recon
