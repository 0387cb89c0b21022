#include "recon/gauge/cylinder.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/error.h"
#include "recon/calibration/calibration_result.h"
#include "recon/calibration/lens_projection.h"

namespace elbowroom::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using AxisGains = Eigen::Matrix<double, 4, Eigen::Dynamic>;
using Normal5 = Eigen::Matrix<double, 5, 5>;

void FillRows(std::span<const TangentSight> sights, CylinderFit* fit) {
  const Vector3d& axis = fit->cylinder.axis_in_world;
  fit->across_in_world[0] = axis.unitOrthogonal();
  fit->across_in_world[1] = axis.cross(fit->across_in_world[0]);
  fit->touches.resize(sights.size());
  fit->jacobian.resize(static_cast<Eigen::Index>(sights.size()), 5);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const Touch touch = TouchOf(fit->cylinder, sights[i]);
    const double one = touch.inward_in_world.dot(fit->across_in_world[0]);
    const double other = touch.inward_in_world.dot(fit->across_in_world[1]);
    fit->jacobian.row(static_cast<Eigen::Index>(i)) << one, other, touch.along_mm * one,
        touch.along_mm * other, -1.0;
    fit->touches[i] = touch;
  }
}

// J^T W J of the used rows. Turns are scaled by `reach_mm`, so that all unknowns are lengths.
Normal5 NormalOf(const CylinderFit& fit, std::span<const double> limits_mm, const std::vector<bool>* is_used,
                 double reach_mm) {
  Normal5 normal = Normal5::Zero();
  for (Eigen::Index i = 0; i < fit.jacobian.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (is_used != nullptr && !(*is_used)[at]) continue;
    Eigen::Matrix<double, 1, 5> row = fit.jacobian.row(i) / limits_mm[at];
    row.segment<2>(2) /= reach_mm;
    normal += row.transpose() * row;
  }
  return normal;
}

double ReachOf(const CylinderFit& fit) {
  double sum = 1.0;
  for (const Touch& touch : fit.touches) sum += touch.along_mm * touch.along_mm;
  return std::sqrt(sum / static_cast<double>(fit.touches.size()));
}

bool IsSolvable(const Normal5& normal) {
  constexpr double kLeastRatio = 1e-9;
  const auto values = Eigen::SelfAdjointEigenSolver<Normal5>(normal).eigenvalues();
  return values[0] > kLeastRatio * values[4];
}

}  // namespace

Touch TouchOf(const Cylinder& cylinder, const TangentSight& sight) {
  const Vector3d &u = cylinder.axis_in_world, &d = sight.sight_in_world;
  const Vector3d across = d.cross(u);
  core::Require(across.norm() > 1e-9, "a sight isn't parallel to the rod's axis");
  Touch touch;
  const Vector3d to_axis = cylinder.point_in_world - sight.eye_in_world;
  touch.inward_in_world = across.normalized() * sight.side;
  const Vector3d& n = touch.inward_in_world;
  // to_axis = distance d - along u + (n.to_axis) n: the parts along d and u, in the plane of both.
  const Vector3d off_sight = n.cross(d), off_axis = n.cross(u);
  touch.along_mm = -off_sight.dot(to_axis) / off_sight.dot(u);
  touch.distance_mm = off_axis.dot(to_axis) / off_axis.dot(d);
  touch.error_mm = n.dot(to_axis) - cylinder.radius_mm;
  const Vector3d n_in_cam = sight.view->camera().cam_from_world().rotation * n;
  const double depth_mm = touch.distance_mm * (sight.view->camera().cam_from_world().rotation * d).z();
  touch.mm_per_px =
      depth_mm / sight.view->plane->focal_px() * AcrossLimit(*sight.point, n_in_cam.head<2>(), 1.0);
  return touch;
}

CylinderFit FitCylinder(const Cylinder& start, std::span<const TangentSight> sights,
                        std::span<const double> limits_mm) {
  constexpr int kMostSteps = 20;
  constexpr double kLeastStepMm = 1e-9;
  CylinderFit fit;
  fit.cylinder = start;
  FillRows(sights, &fit);
  for (int step = 0; step < kMostSteps; ++step) {
    const double reach_mm = ReachOf(fit);
    const Normal5 normal = NormalOf(fit, limits_mm, nullptr, reach_mm);
    fit.is_found = IsSolvable(normal);
    if (!fit.is_found) return fit;
    Eigen::Matrix<double, 5, 1> gradient = Eigen::Matrix<double, 5, 1>::Zero();
    for (std::size_t i = 0; i < sights.size(); ++i) {
      gradient += fit.jacobian.row(static_cast<Eigen::Index>(i)).transpose() * fit.touches[i].error_mm /
                  (limits_mm[i] * limits_mm[i]);
    }
    gradient.segment<2>(2) /= reach_mm;
    Eigen::Matrix<double, 5, 1> change = -normal.ldlt().solve(gradient);
    const double size_mm = change.norm();
    change.segment<2>(2) /= reach_mm;
    Cylinder& c = fit.cylinder;
    c.point_in_world += change[0] * fit.across_in_world[0] + change[1] * fit.across_in_world[1];
    c.axis_in_world =
        (c.axis_in_world + change[2] * fit.across_in_world[0] + change[3] * fit.across_in_world[1])
            .normalized();
    c.radius_mm += change[4];
    FillRows(sights, &fit);
    if (size_mm < kLeastStepMm) break;
  }
  return fit;
}

AxisGains AxisGain(const CylinderFit& fit, std::span<const double> limits_mm,
                   const std::vector<bool>& is_used) {
  const double reach_mm = ReachOf(fit);
  const Normal5 normal = NormalOf(fit, limits_mm, &is_used, reach_mm);
  if (!IsSolvable(normal)) return {};
  const Normal5 inverse = normal.inverse();
  AxisGains gain = AxisGains::Zero(4, fit.jacobian.rows());
  for (Eigen::Index i = 0; i < fit.jacobian.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!is_used[at]) continue;
    Eigen::Matrix<double, 5, 1> row = fit.jacobian.row(i).transpose() / (limits_mm[at] * limits_mm[at]);
    row.segment<2>(2) /= reach_mm;
    Eigen::Matrix<double, 5, 1> column = -(inverse * row);
    column.segment<2>(2) /= reach_mm;
    gain.col(i) = column.head<4>();
  }
  return gain;
}

Eigen::VectorXd ErrorByParameters(const Touch& touch, const TangentSight& sight) {
  const core::CameraModel& camera = sight.view->camera();
  const LensParameters lens = LensParametersOf(camera.calibration());
  const ParameterBlock block{0, lens.count()};
  Eigen::VectorXd by_parameters = Eigen::VectorXd::Zero(block.size());
  const Matrix3d& rotation = camera.cam_from_world().rotation;
  const Vector3d touched = sight.eye_in_world + touch.distance_mm * sight.sight_in_world;
  const Vector3d turned = rotation * touched;
  const auto projected = ProjectWithDerivatives(lens, turned + camera.cam_from_world().translation_mm);
  if (!projected) return by_parameters;
  // The crossing stays where it is. If the camera would now see the touched point farther in, the sight
  // passes as much farther out. At a constant depth:
  Eigen::Matrix<double, 3, 2> x_from_pixel = Eigen::Matrix<double, 3, 2>::Zero();
  x_from_pixel.topRows<2>() = projected->by_x_in_cam.leftCols<2>().inverse();
  const Eigen::RowVector2d by_pixel = (rotation * touch.inward_in_world).transpose() * x_from_pixel;
  const Vector3d by_x = (by_pixel * projected->by_x_in_cam).transpose();
  by_parameters.head(block.intrinsics) = (by_pixel * projected->by_values).transpose();
  // A turn w moves the point by w x turned.
  by_parameters.segment<3>(block.rotation()) = turned.cross(by_x);
  by_parameters.segment<3>(block.translation()) = by_x;
  return by_parameters;
}

}  // namespace elbowroom::recon
