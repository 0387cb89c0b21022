#include "recon/consistency/tangents.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "core/error.h"
#include "recon/consistency/tangent_fit.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using PlaneRows = Eigen::Matrix<double, 2, 3>;

// The vertices with the least and the largest angle; nothing if the silhouette isn't all within a quarter
// turn from the plane with angle 0, as one around the epipole isn't.
std::optional<std::array<std::uint32_t, kTangentSides>> OutermostVertices(const Contour& contour,
                                                                          const PlaneRows& rows,
                                                                          double focal_px) {
  // tan(angle) is enough to compare: it grows with the angle.
  const double zero_x = rows(0, 0), zero_y = rows(0, 1), zero = rows(0, 2) * focal_px;
  const double quarter_x = rows(1, 0), quarter_y = rows(1, 1), quarter = rows(1, 2) * focal_px;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  std::array<std::uint32_t, kTangentSides> found{};
  for (std::uint32_t i = 0; i < contour.vertices.size(); ++i) {
    const Vector2d& p = contour.vertices[i];
    const double cosine = zero_x * p.x() + zero_y * p.y() + zero;
    if (cosine <= 0.0) return std::nullopt;
    const double tangent = (quarter_x * p.x() + quarter_y * p.y() + quarter) / cosine;
    if (tangent < lowest) lowest = tangent, found[0] = i;
    if (tangent > highest) highest = tangent, found[1] = i;
  }
  return found;
}

// How a plane's angle changes with the position that it goes through.
struct AngleAt {
  double angle_rad;
  Vector2d slope;  // rad / plane unit
};

AngleAt AngleAtPosition(const PlaneRows& rows, const Vector2d& position, double focal_px) {
  const Vector2d cs = rows * Vector3d(position.x(), position.y(), focal_px);
  const Vector2d slope =
      (cs[0] * rows.row(1).head<2>().transpose() - cs[1] * rows.row(0).head<2>().transpose()) /
      cs.squaredNorm();
  return {std::atan2(cs[1], cs[0]), slope};
}

// By how much a line moves in the plane, along its normal, if it moves by a pixel across itself in the
// picture: |J' normal| with J the derivative of the position by the pixel.
double PlanePerPx(const UndistortedPlane& plane, const Vector2d& position, const Vector2d& normal) {
  constexpr double kStep = 0.5;  // plane units
  const core::CameraModel& camera = plane.camera();
  const Vector2d pixel = camera.PixelFromNormalised(position / plane.focal_px());
  Eigen::Matrix2d by_position;
  for (int axis = 0; axis < 2; ++axis) {
    const Vector2d moved = position + kStep * Vector2d::Unit(axis);
    by_position.col(axis) = (camera.PixelFromNormalised(moved / plane.focal_px()) - pixel) / kStep;
  }
  return (by_position.inverse().transpose() * normal).norm();
}

TangentOrSkip TangentAt(const EpipolarPairs& pairs, const EpipolarPair& pair, core::CameraIndex camera,
                        const Contour& contour, std::uint32_t vertex, TangentSide side,
                        const TangentOptions& options) {
  const UndistortedPlane& plane = pairs.plane(camera);
  const PlaneRows& rows = pair.From(camera);
  const Vector2d& start = contour.vertices[vertex];
  const Vector2d pixel = plane.camera().PixelFromNormalised(start / plane.focal_px());
  if (!IsWithin(plane.camera(), pixel, options.border_px)) return TangencySkip::kAtBorder;
  const AngleAt at = AngleAtPosition(rows, start, plane.focal_px());
  const double sign = side == TangentSide::kHighest ? 1.0 : -1.0;
  const Vector2d outwards = sign * at.slope.normalized();
  const double plane_per_px = PlanePerPx(plane, start, outwards);
  const double px_per_rad = 1.0 / (at.slope.norm() * plane_per_px);
  if (px_per_rad < options.least_px_per_rad) return TangencySkip::kAtEpipole;
  const std::optional<OutermostFit> fit = FitOutermost(contour, vertex, outwards, plane_per_px, options);
  if (!fit) return TangencySkip::kUneven;

  Tangent tangent;
  const Vector2d along(-outwards.y(), outwards.x());
  tangent.position = start + plane_per_px * (fit->along_px * along + fit->beyond_px * outwards);
  tangent.angle_rad = at.angle_rad + sign * fit->beyond_px / px_per_rad;
  tangent.sigma_px = fit->sigma_px;
  tangent.px_per_rad = px_per_rad;
  const Vector3d sight_in_cam(tangent.position.x(), tangent.position.y(), plane.focal_px());
  tangent.sight_in_world = (plane.camera().cam_from_world().rotation.transpose() * sight_in_cam).normalized();
  const core::CameraIndex other = camera == pair.a ? pair.b : pair.a;
  tangent.is_seen_by_other =
      pairs.SeesSight(other, plane.camera().center_in_world(), tangent.sight_in_world, options.border_px);
  return tangent;
}

bool TouchesBorder(const core::BitMask& mask) {
  const std::size_t words = mask.words_per_row();
  const auto height = static_cast<std::size_t>(mask.height_px());
  for (std::size_t i = 0; i < words; ++i)
    if ((mask.words()[i] | mask.words()[(height - 1) * words + i]) != 0) return true;
  for (int y = 0; y < mask.height_px(); ++y)
    if (mask.At(0, y) || mask.At(mask.width_px() - 1, y)) return true;
  return false;
}

}  // namespace

void TangentOptions::Validate() const {
  core::Require(boundary_sigma_px > 0.0, "boundary_sigma_px is positive");
  core::Require(correlation_px >= 0.0, "correlation_px isn't negative");
  core::Require(depth_px > 0.0 && reach_px > 0.0, "depth_px and reach_px are positive");
  core::Require(border_px >= 0.0, "border_px isn't negative");
  core::Require(least_px_per_rad > 0.0, "least_px_per_rad is positive");
}

CameraTangents FindTangents(const EpipolarPairs& pairs, core::CameraIndex camera, const core::SoftMask& mask,
                            const Contour& contour, const TangentOptions& options) {
  const UndistortedPlane& plane = pairs.plane(camera);
  core::Require(mask.mask.width_px() == plane.camera().width_px() &&
                    mask.mask.height_px() == plane.camera().height_px(),
                "a silhouette has its camera's size");
  options.Validate();
  CameraTangents found;
  found.is_whole = !TouchesBorder(mask.mask);
  found.of_other.assign(pairs.camera_count(), {TangencySkip::kNothingSeen, TangencySkip::kNothingSeen});
  if (contour.vertices.empty()) return found;
  for (const EpipolarPair& pair : pairs.pairs()) {
    if (pair.a != camera && pair.b != camera) continue;
    auto& sides = found.of_other[pair.a == camera ? pair.b : pair.a];
    const auto outermost = OutermostVertices(contour, pair.From(camera), plane.focal_px());
    for (std::size_t side = 0; side < kTangentSides; ++side) {
      sides[side] = outermost ? TangentAt(pairs, pair, camera, contour, (*outermost)[side],
                                          static_cast<TangentSide>(side), options)
                              : TangentOrSkip(TangencySkip::kAtEpipole);
    }
  }
  return found;
}

CameraTangents FindTangents(const EpipolarPairs& pairs, core::CameraIndex camera, const core::SoftMask& mask,
                            const TangentOptions& options) {
  return FindTangents(pairs, camera, mask, TraceContour(mask, false, pairs.plane(camera)), options);
}

}  // namespace elbowroom::recon
