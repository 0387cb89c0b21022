#include "recon/error_budget/hull_errors.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "recon/contours/silhouette.h"
#include "recon/error_budget/surface_bounds.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using core::ErrorBudget;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of a value that is anywhere within one pixel: 1 / sqrt(12).
constexpr double kWithinPixelSigmaPx = 0.28867513459481287;
bool IsInPicture(const core::CameraModel& camera, const Vector3d& x_in_world) {
  const std::optional<Vector2d> pixel = camera.Project(x_in_world);
  return pixel && pixel->x() >= -0.5 && pixel->y() >= -0.5 && pixel->x() <= camera.width_px() - 0.5 &&
         pixel->y() <= camera.height_px() - 0.5;
}

}  // namespace

HullErrors::HullErrors(const core::Rig& rig, core::RigErrors errors)
    : workspace_mm_(rig.workspace_mm), errors_(std::move(errors)) {
  errors_.Validate();
  int parameters = 0;
  for (const core::CameraModel& camera : rig.cameras) {
    const LensParameters lens = LensParametersOf(camera.calibration());
    cameras_.push_back({camera, lens, {parameters, lens.count()}});
    parameters += cameras_.back().parameters.size();
  }
  core::Require(errors_.covariance.rows() == parameters && errors_.covariance.cols() == parameters,
                "the covariance has a row for each parameter of the cameras");
}

// A contour's normal n in the picture and the cone's normal N in space belong together: with A the
// derivative of the pixel by the point, A^T n is parallel to N. Both are 0 along the line of sight. A cone
// that is shifted by s along N moves the contour by |A^T n| s; parameters that change by d move it by n^T B
// d.
std::optional<HullErrors::Bound> HullErrors::BoundBy(std::size_t camera, const Vector3d& normal_in_world,
                                                     const Vector3d& x_in_world) const {
  const Camera& seen_by = cameras_[camera];
  const auto pixel = PixelResponseAt(seen_by.lens, seen_by.model.cam_from_world(), x_in_world);
  if (!pixel) return std::nullopt;
  const Eigen::Matrix<double, 2, 3>& by_x = pixel->by_x_in_world;
  const Matrix2d squares = by_x * by_x.transpose();
  const Vector2d n = (squares.inverse() * (by_x * normal_in_world)).normalized();
  Bound bound;
  bound.normal_in_world = normal_in_world;
  bound.mm_per_px = 1.0 / (by_x.transpose() * n).norm();
  bound.shift_mm = Eigen::RowVectorXd::Zero(errors_.covariance.cols());
  bound.shift_mm.segment(seen_by.parameters.first, seen_by.parameters.size()) =
      bound.mm_per_px * n.transpose() * pixel->by_parameters;
  return bound;
}

std::vector<HullErrors::Bound> HullErrors::BoundsAt(const VisualHull& hull,
                                                    const Vector3d& x_in_world) const {
  std::vector<Bound> bounds;
  for (const SurfaceBound& surface : SurfaceBoundsAt(hull, x_in_world)) {
    if (!surface.edge) {
      bounds.push_back(
          {surface.normal_in_world, Eigen::RowVectorXd::Zero(errors_.covariance.cols()), 0.0, true});
      continue;
    }
    auto bound = BoundBy(surface.edge->camera, surface.normal_in_world, x_in_world);
    if (!bound) continue;
    bound->is_located = !hull.silhouettes()[surface.edge->camera]->soft_mask().levels.empty();
    bounds.push_back(std::move(*bound));
  }
  return bounds;
}

ErrorBudget HullErrors::At(const VisualHull& hull, const Vector3d& x_of_hull,
                           const Vector3d& x_of_part) const {
  const std::vector<Bound> bounds = BoundsAt(hull, x_of_hull);
  const Vector3d towards_part = (x_of_part - x_of_hull).normalized();
  std::vector<Vector3d> normals;
  for (const Bound& bound : bounds) normals.push_back(bound.normal_in_world);
  const std::optional<std::vector<double>> shares = SharesOf(normals, towards_part);
  if (!shares) return WorstAt(x_of_hull);
  Eigen::RowVectorXd shift_mm = Eigen::RowVectorXd::Zero(errors_.covariance.cols());
  ErrorBudget budget;
  double footprint_mm2 = 0.0, segmentation_mm2 = 0.0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double weight = (*shares)[i];
    shift_mm += weight * bounds[i].shift_mm;
    const double pixel_mm = weight * bounds[i].mm_per_px;
    const double sigma_px = bounds[i].is_located ? errors_.boundary_sigma_px : kWithinPixelSigmaPx;
    (bounds[i].is_located ? segmentation_mm2 : footprint_mm2) += std::pow(pixel_mm * sigma_px, 2);
  }
  budget.calibration_mm = std::sqrt(std::max(0.0, (shift_mm * errors_.covariance).dot(shift_mm)));
  budget.footprint_mm = std::sqrt(footprint_mm2);
  budget.segmentation_mm = std::sqrt(segmentation_mm2);
  return budget;
}

ErrorBudget HullErrors::OfCone(core::CameraIndex camera, const Vector3d& normal_in_world,
                               const Vector3d& x_in_world, bool is_located) const {
  ErrorBudget budget;
  const std::optional<Bound> bound = BoundBy(camera, normal_in_world, x_in_world);
  if (!bound) return budget;
  const ParameterBlock& block = cameras_[camera].parameters;
  const Eigen::RowVectorXd shift_mm = bound->shift_mm.segment(block.first, block.size());
  const auto own = errors_.covariance.block(block.first, block.first, block.size(), block.size());
  budget.calibration_mm = std::sqrt(std::max(0.0, (shift_mm * own).dot(shift_mm)));
  (is_located ? budget.segmentation_mm : budget.footprint_mm) =
      bound->mm_per_px * (is_located ? errors_.boundary_sigma_px : kWithinPixelSigmaPx);
  return budget;
}

ErrorBudget HullErrors::WorstAt(const Vector3d& x_in_world) const {
  ErrorBudget worst;
  for (const Camera& camera : cameras_) {
    if (!IsInPicture(camera.model, x_in_world)) continue;
    const auto pixel = PixelResponseAt(camera.lens, camera.model.cam_from_world(), x_in_world);
    if (!pixel) continue;
    // Both are found in the plane across the line of sight: A+ = A^T (A A^T)^-1.
    const Eigen::Matrix<double, 3, 2> mm_per_px =
        pixel->by_x_in_world.transpose() *
        (pixel->by_x_in_world * pixel->by_x_in_world.transpose()).inverse();
    const ParameterBlock& block = camera.parameters;
    const Matrix2d covariance_px2 =
        pixel->by_parameters *
        errors_.covariance.block(block.first, block.first, block.size(), block.size()) *
        pixel->by_parameters.transpose();
    const auto largest = [](const Eigen::Matrix3d& m) {
      return std::sqrt(std::max(0.0, m.selfadjointView<Eigen::Lower>().eigenvalues()[2]));
    };
    ErrorBudget budget;
    budget.calibration_mm = largest(mm_per_px * covariance_px2 * mm_per_px.transpose());
    const double pixel_mm = largest(mm_per_px * mm_per_px.transpose());
    // Before a hull is there, nobody knows which kind its silhouettes are: the larger error counts.
    (errors_.boundary_sigma_px > kWithinPixelSigmaPx ? budget.segmentation_mm : budget.footprint_mm) =
        pixel_mm * std::max(errors_.boundary_sigma_px, kWithinPixelSigmaPx);
    if (budget.CombinedMm() > worst.CombinedMm()) worst = budget;
  }
  return worst;
}

ErrorBudget HullErrors::WorstIn(const Eigen::AlignedBox3d& box_in_world) const {
  ErrorBudget worst;
  if (box_in_world.isEmpty()) return worst;
  // The hull is in the workspace, so that of a part outside it the nearest place counts.
  const Eigen::AlignedBox3d box(
      box_in_world.min().cwiseMax(workspace_mm_.min()).cwiseMin(workspace_mm_.max()),
      box_in_world.max().cwiseMax(workspace_mm_.min()).cwiseMin(workspace_mm_.max()));
  for (int i = 0; i < 27; ++i) {
    const int column = i % 3, row = i / 3 % 3, layer = i / 9;
    const Vector3d share(0.5 * column, 0.5 * row, 0.5 * layer);
    const ErrorBudget budget = WorstAt(box.min() + share.cwiseProduct(box.sizes()));
    if (budget.CombinedMm() > worst.CombinedMm()) worst = budget;
  }
  return worst;
}

}  // namespace elbowroom::recon
