#include "recon/gauge/rod_widths.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "recon/gauge/width_range.h"

namespace elbowroom::recon {
namespace {

using Eigen::VectorXd;
using Axis4 = Eigen::Matrix<double, 1, 4>;

std::vector<SidePoint> SidePoints(const FittedRod& rod, const std::vector<std::size_t>& of_camera) {
  std::vector<SidePoint> points;
  for (const std::size_t i : of_camera) {
    const Touch& touch = rod.fit.touches[i];
    points.push_back({rod.sights[i].side, touch.along_mm, touch.error_mm, rod.limits_mm[i]});
  }
  return points;
}

bool HasBothSides(const std::vector<SidePoint>& points) {
  constexpr std::ptrdiff_t kFewest = 4;
  const auto ones = std::ranges::count(points, 1, &SidePoint::side);
  return ones >= kFewest && std::ssize(points) - ones >= kFewest;
}

// Weights of the radius by least squares over one camera's sights, with a shift and a turn of its own.
VectorXd RadiusWeights(const FittedRod& rod, const std::vector<std::size_t>& of_camera) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::MatrixX3d rows(static_cast<Eigen::Index>(of_camera.size()), 3);
  const double reach_mm = std::max(1.0, rod.to_mm - rod.from_mm);
  for (std::size_t k = 0; k < of_camera.size(); ++k) {
    const std::size_t i = of_camera[k];
    const int side = rod.sights[i].side;
    rows.row(static_cast<Eigen::Index>(k)) << 1.0, side, side * rod.fit.touches[i].along_mm / reach_mm;
    rows.row(static_cast<Eigen::Index>(k)) /= rod.limits_mm[i];
  }
  normal = rows.transpose() * rows;
  const Eigen::Vector3d radius = normal.ldlt().solve(Eigen::Vector3d::UnitX());
  VectorXd weights = VectorXd::Zero(static_cast<Eigen::Index>(rod.sights.size()));
  for (std::size_t k = 0; k < of_camera.size(); ++k) {
    weights[static_cast<Eigen::Index>(of_camera[k])] =
        rows.row(static_cast<Eigen::Index>(k)).dot(radius) / rod.limits_mm[of_camera[k]];
  }
  return weights;
}

// How a figure with these weights changes with the axis.
Axis4 ByAxis(const FittedRod& rod, const VectorXd& weights) {
  return weights.transpose() * rod.fit.jacobian.leftCols<4>();
}

double Sum(const FittedRod& rod, const VectorXd& weights) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rod.fit.touches.size(); ++i)
    sum += weights[static_cast<Eigen::Index>(i)] * rod.fit.touches[i].error_mm;
  return sum;
}

// Of segmented silhouettes: a bias that all crossings may share, and the spread of their noise.
double SegmentedMm(const FittedRod& rod, const VectorXd& weights, const BoundaryLimits& limits) {
  // Crossings are a pixel apart, and a boundary is located from the five around.
  constexpr double kCorrelated = 5.0;
  double bias_mm = 0.0, variance_mm2 = 0.0;
  for (std::size_t i = 0; i < rod.sights.size(); ++i) {
    const double weight_mm = std::abs(weights[static_cast<Eigen::Index>(i)]) * rod.fit.touches[i].mm_per_px;
    bias_mm += weight_mm * limits.segmented_bias_px;
    variance_mm2 += std::pow(weight_mm * limits.segmented_noise_px, 2);
  }
  return bias_mm + kGaugeSigmas * std::sqrt(kCorrelated * variance_mm2);
}

double MeanMmPerPx(const FittedRod& rod, const std::vector<std::size_t>& of_camera) {
  double sum = 0.0;
  for (const std::size_t i : of_camera) sum += rod.fit.touches[i].mm_per_px;
  return sum / static_cast<double>(of_camera.size());
}

}  // namespace

std::optional<CameraWidth> WidthIn(const FittedRod& rod, int camera, const RodErrors& errors,
                                   const BoundaryLimits& limits) {
  const std::vector<std::size_t> of_camera = rod.SightsOf(camera);
  const std::vector<SidePoint> points = SidePoints(rod, of_camera);
  if (!HasBothSides(points)) return std::nullopt;
  VectorXd weights = RadiusWeights(rod, of_camera);
  CameraWidth width;
  width.is_hard = rod.sights[of_camera.front()].view->is_ready;
  double correction_mm = Sum(rod, weights);
  double silhouettes_mm = SegmentedMm(rod, weights, limits);
  if (width.is_hard) {
    const RadiusRange range = RadiiWithin(points);
    correction_mm = 0.5 * (range.low_mm + range.high_mm);
    silhouettes_mm = 0.5 * (range.high_mm - range.low_mm);
    width.excess_px = range.excess_mm / MeanMmPerPx(rod, of_camera);
  }
  // The distance of the rod is that of the common axis.
  const auto gain = AxisGain(rod.fit, rod.limits_mm, std::vector<bool>(rod.sights.size(), true));
  VectorXd by_axis = VectorXd::Zero(weights.size());
  if (gain.size() > 0) by_axis = (ByAxis(rod, weights) * gain).transpose();
  width.diameter.value_mm = 2.0 * (rod.fit.cylinder.radius_mm + correction_mm);
  width.diameter.bound.silhouettes_mm = 2.0 * silhouettes_mm;
  width.diameter.bound.distance_mm = 2.0 * errors.WorstMm(by_axis);
  width.diameter.bound.calibration_mm = 2.0 * errors.CalibrationMm(errors.ByParameters(weights + by_axis));
  return width;
}

CombinedWidth Combined(std::span<const CameraWidth> widths) {
  CombinedWidth combined;
  double low_mm = -std::numeric_limits<double>::infinity();
  double high_mm = -low_mm;
  double sum = 0.0, mean_mm = 0.0, half_mm = 0.0, narrowest_mm = high_mm;
  GaugeBound share;  // of a bound, by source
  for (const CameraWidth& width : widths) {
    const double value_mm = width.diameter.value_mm, total_mm = width.diameter.bound.total_mm();
    const double weight = 1.0 / (total_mm * total_mm);
    sum += weight;
    share.silhouettes_mm += weight * width.diameter.bound.silhouettes_mm;
    share.distance_mm += weight * width.diameter.bound.distance_mm;
    share.calibration_mm += weight * width.diameter.bound.calibration_mm;
    mean_mm += weight * value_mm;
    half_mm += weight * total_mm;
    narrowest_mm = std::min(narrowest_mm, total_mm);
    low_mm = std::max(low_mm, value_mm - total_mm);
    high_mm = std::min(high_mm, value_mm + total_mm);
  }
  mean_mm /= sum;
  half_mm /= sum;
  combined.agree = low_mm <= high_mm;
  const bool is_hard = std::ranges::all_of(widths, &CameraWidth::is_hard);
  combined.diameter.value_mm = is_hard && combined.agree ? 0.5 * (low_mm + high_mm) : mean_mm;
  // Ranges that barely overlap are more often a sign of a crossing that isn't the rod's than good luck.
  constexpr double kLeastShare = 0.5;
  const double bound_mm =
      is_hard && combined.agree ? std::max(0.5 * (high_mm - low_mm), kLeastShare * narrowest_mm) : half_mm;
  const double scale = bound_mm / (share.silhouettes_mm + share.distance_mm + share.calibration_mm);
  combined.diameter.bound = {scale * share.silhouettes_mm, scale * share.distance_mm,
                             scale * share.calibration_mm};
  return combined;
}

std::optional<BoundedMm> OffsetOf(const FittedRod& rod, int camera, const RodErrors& errors) {
  std::vector<bool> others(rod.sights.size());
  VectorXd weights = VectorXd::Zero(static_cast<Eigen::Index>(rod.sights.size()));
  int counts[2] = {0, 0};
  for (const std::size_t i : rod.SightsOf(camera)) ++counts[rod.sights[i].side > 0 ? 0 : 1];
  if (counts[0] == 0 || counts[1] == 0) return std::nullopt;
  for (std::size_t i = 0; i < rod.sights.size(); ++i) {
    others[i] = rod.sights[i].camera != camera;
    if (others[i]) continue;
    weights[static_cast<Eigen::Index>(i)] = rod.sights[i].side > 0 ? 0.5 / counts[0] : -0.5 / counts[1];
  }
  const auto gain = AxisGain(rod.fit, rod.limits_mm, others);
  if (gain.size() == 0) return std::nullopt;
  const VectorXd by_axis = (ByAxis(rod, weights) * gain).transpose();
  BoundedMm offset;
  offset.value_mm = Sum(rod, weights + by_axis);
  offset.bound.silhouettes_mm = errors.WorstMm(weights);
  offset.bound.distance_mm = errors.WorstMm(by_axis);
  offset.bound.calibration_mm = errors.CalibrationMm(errors.ByParameters(weights + by_axis));
  return offset;
}

}  // namespace elbowroom::recon
