#include "recon/gauge/rod_shape.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "recon/gauge/rod_ends.h"
#include "recon/gauge/width_range.h"

namespace elbowroom::recon {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Unknowns: for each camera a shift and a turn, the radius, and the bow in the two directions across the
// axis, in mm at the ends of what is seen.
MatrixXd BowRows(const FittedRod& rod) {
  const auto cameras = static_cast<Eigen::Index>(rod.cameras.size());
  MatrixXd rows = MatrixXd::Zero(static_cast<Eigen::Index>(rod.sights.size()), 2 * cameras + 3);
  const double half_mm = 0.5 * (rod.to_mm - rod.from_mm), middle_mm = 0.5 * (rod.to_mm + rod.from_mm);
  for (std::size_t i = 0; i < rod.sights.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto camera = std::ranges::find(rod.cameras, rod.sights[i].camera) - rod.cameras.begin();
    const double s = (rod.fit.touches[i].along_mm - middle_mm) / half_mm;
    rows(row, 2 * camera) = rod.sights[i].side;
    rows(row, 2 * camera + 1) = rod.sights[i].side * s;
    rows(row, 2 * cameras) = 1.0;
    for (int k = 0; k < 2; ++k)
      rows(row, 2 * cameras + 1 + k) =
          -s * s *
          rod.fit.touches[i].inward_in_world.dot(rod.fit.across_in_world[static_cast<std::size_t>(k)]);
    rows.row(row) /= rod.limits_mm[i];
  }
  return rows;
}

// The bows across the axis that all ready masks allow: a strip of the plane for each camera.
struct BowStrip {
  Vector2d normal;  // the camera's sideways direction, in terms of across_in_world
  double low_mm;
  double high_mm;

  [[nodiscard]] bool Holds(const Vector2d& bow_mm) const {
    constexpr double kRoundingMm = 1e-6;
    const double along = normal.dot(bow_mm);
    return along >= low_mm - kRoundingMm && along <= high_mm + kRoundingMm;
  }
};

std::vector<BowStrip> BowStrips(const FittedRod& rod) {
  std::vector<BowStrip> strips;
  const double half_mm = 0.5 * (rod.to_mm - rod.from_mm), middle_mm = 0.5 * (rod.to_mm + rod.from_mm);
  for (const int camera : rod.cameras) {
    std::vector<SidePoint> points;
    Vector3d sideways = Vector3d::Zero();
    for (const std::size_t i : rod.SightsOf(camera)) {
      const Touch& touch = rod.fit.touches[i];
      points.push_back({rod.sights[i].side, touch.along_mm - middle_mm, touch.error_mm, rod.limits_mm[i]});
      sideways -= rod.sights[i].side * touch.inward_in_world;
    }
    const auto ones = std::ranges::count(points, 1, &SidePoint::side);
    if (ones < 2 || std::ssize(points) - ones < 2) continue;
    const BowRange range = BowsWithin(points, half_mm);
    const Vector2d normal(sideways.dot(rod.fit.across_in_world[0]), sideways.dot(rod.fit.across_in_world[1]));
    strips.push_back({normal.normalized(), range.low_mm, range.high_mm});
  }
  return strips;
}

// The distance from a bow to the farthest that all strips allow; nothing where they allow none, or any.
std::optional<double> FarthestMm(const std::vector<BowStrip>& strips, const Vector2d& from_mm) {
  std::optional<double> farthest_mm;
  for (std::size_t a = 0; a < strips.size(); ++a) {
    for (std::size_t b = a + 1; b < strips.size(); ++b) {
      Eigen::Matrix2d normals;
      normals << strips[a].normal.transpose(), strips[b].normal.transpose();
      if (std::abs(normals.determinant()) < 1e-6) continue;
      for (const double one : {strips[a].low_mm, strips[a].high_mm}) {
        for (const double other : {strips[b].low_mm, strips[b].high_mm}) {
          const Vector2d corner = normals.inverse() * Vector2d(one, other);
          if (std::ranges::all_of(strips, [&](const BowStrip& strip) { return strip.Holds(corner); }))
            farthest_mm = std::max(farthest_mm.value_or(0.0), (corner - from_mm).norm());
        }
      }
    }
  }
  return farthest_mm;
}

// An end by one camera: where it is along the axis, and what makes it wrong.
struct MeasuredEnd {
  double along_mm = 0.0;
  double silhouettes_mm = 0.0;
  double distance_mm = 0.0;
  VectorXd by_parameters;

  [[nodiscard]] double bound_mm() const { return silhouettes_mm + distance_mm; }
};

MeasuredEnd Measure(const FittedRod& rod, int camera, const RodView& view, const SeenEnd& end,
                    const RodErrors& errors, const BoundaryLimits& limits) {
  const Cylinder& cylinder = rod.fit.cylinder;
  const Vector3d sight = view.SightInWorld(end.position);
  const double along_mm = AlongAxis(cylinder, view, end.position);
  const double outward = along_mm > 0.0 ? 1.0 : -1.0;
  const double cosine = cylinder.axis_in_world.dot(sight);
  const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 1e-6));
  // A flat end's rim reaches beyond the axis' end, and so does a half ball, by less.
  const double flat_mm = cylinder.radius_mm * std::abs(cosine) / sine;
  const double round_mm = cylinder.radius_mm * (1.0 / sine - 1.0);
  const Vector3d end_in_world = cylinder.point_in_world + along_mm * cylinder.axis_in_world;
  const double depth_mm = (view.camera().cam_from_world() * end_in_world).z();
  const double mm_per_px = depth_mm / view.plane->focal_px() * end.step / sine;
  // The tip may lie beyond the last row of centres that it reaches: twice what a crossing may be off.
  const double px =
      view.is_ready ? 2.0 * limits.ready_px : 2.0 * (limits.segmented_bias_px + limits.segmented_noise_px);
  MeasuredEnd measured;
  measured.along_mm = along_mm - outward * 0.5 * (flat_mm + round_mm);
  measured.silhouettes_mm = px * mm_per_px + 0.5 * (flat_mm - round_mm);
  // An axis that is farther along the line of sight meets it elsewhere.
  const Vector3d away = (sight - cosine * cylinder.axis_in_world) / sine;
  Eigen::RowVector4d by_axis;
  for (int k = 0; k < 2; ++k) {
    by_axis[k] = away.dot(rod.fit.across_in_world[static_cast<std::size_t>(k)]);
    by_axis[k + 2] = along_mm * by_axis[k];
  }
  const auto gain = AxisGain(rod.fit, rod.limits_mm, std::vector<bool>(rod.sights.size(), true));
  const VectorXd weights = cosine / sine * (by_axis * gain).transpose();
  measured.distance_mm = errors.WorstMm(weights);
  TangentSight tip = rod.sights[rod.SightsOf(camera).front()];
  tip.sight_in_world = sight;
  Touch touch;
  touch.inward_in_world = (cylinder.axis_in_world - cosine * sight) / sine;
  touch.distance_mm = (end_in_world - tip.eye_in_world).dot(sight);
  measured.by_parameters =
      errors.ByParameters(weights) - errors.OfCamera(camera, ErrorByParameters(touch, tip) / sine);
  return measured;
}

}  // namespace

std::optional<BoundedMm> StraightnessOf(const FittedRod& rod, const RodErrors& errors) {
  constexpr double kLeastRatio = 1e-7;
  const MatrixXd rows = BowRows(rod);
  const MatrixXd normal = rows.transpose() * rows;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(normal);
  if (!(eigen.eigenvalues()[0] > kLeastRatio * eigen.eigenvalues()[normal.rows() - 1])) return std::nullopt;
  MatrixXd unit = MatrixXd::Zero(normal.rows(), 2);
  unit(normal.rows() - 2, 0) = unit(normal.rows() - 1, 1) = 1.0;
  MatrixXd weights = rows * normal.ldlt().solve(unit);  // sights x 2
  VectorXd errors_mm(weights.rows());
  for (Eigen::Index i = 0; i < weights.rows(); ++i) {
    weights.row(i) /= rod.limits_mm[static_cast<std::size_t>(i)];
    errors_mm[i] = rod.fit.touches[static_cast<std::size_t>(i)].error_mm;
  }
  const Vector2d bow_mm = weights.transpose() * errors_mm;
  BoundedMm straightness{bow_mm.norm(), {}};
  straightness.bound.silhouettes_mm =
      Vector2d(errors.WorstMm(weights.col(0)), errors.WorstMm(weights.col(1))).norm();
  if (std::ranges::all_of(rod.sights, [](const TangentSight& sight) { return sight.view->is_ready; })) {
    if (const std::optional<double> farthest_mm = FarthestMm(BowStrips(rod), bow_mm))
      straightness.bound.silhouettes_mm = *farthest_mm;
  }
  straightness.bound.calibration_mm = Vector2d(errors.CalibrationMm(errors.ByParameters(weights.col(0))),
                                               errors.CalibrationMm(errors.ByParameters(weights.col(1))))
                                          .norm();
  return straightness;
}

std::optional<BoundedMm> LengthOf(const FittedRod& rod, std::span<const RodView> views,
                                  std::span<const RodStrip> strips, const RodErrors& errors,
                                  const BoundaryLimits& limits) {
  std::optional<MeasuredEnd> ends[2];  // at the negative and the positive side
  for (const RodStrip& strip : strips) {
    if (std::ranges::count(rod.cameras, strip.camera) == 0) continue;
    const RodView& view = views[static_cast<std::size_t>(strip.camera)];
    for (const bool is_forward : {false, true}) {
      const auto tip = FreeEnd(view, strip.strip, is_forward);
      if (!tip) continue;
      MeasuredEnd end = Measure(rod, strip.camera, view, *tip, errors, limits);
      auto& best = ends[end.along_mm > 0.0 ? 1 : 0];
      if (!best || end.bound_mm() < best->bound_mm()) best = std::move(end);
    }
  }
  if (!ends[0] || !ends[1]) return std::nullopt;
  BoundedMm length{ends[1]->along_mm - ends[0]->along_mm, {}};
  length.bound.silhouettes_mm = ends[0]->silhouettes_mm + ends[1]->silhouettes_mm;
  length.bound.distance_mm = ends[0]->distance_mm + ends[1]->distance_mm;
  length.bound.calibration_mm = errors.CalibrationMm(ends[1]->by_parameters - ends[0]->by_parameters);
  return length;
}

}  // namespace elbowroom::recon
