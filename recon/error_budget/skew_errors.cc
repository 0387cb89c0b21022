#include "recon/error_budget/skew_errors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error_budget.h"
#include "core/infinity.h"
#include "recon/contours/silhouette.h"
#include "recon/error_budget/surface_bounds.h"
#include "recon/error_budget/swept_margins.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Contours within this distance of a point move as fast as the one at the point, or faster: about the width
// of two fingers. Where a contour moved farther than its object is wide, its own distance to the contour
// before is too short, but not that of the object's other side.
constexpr double kNeighbourhoodMm = 30.0;
// Contours that moved less than this may stand still: masks flicker by a pixel.
constexpr double kStillPx = 1.0;

// Where a ball falls in a camera's plane. A pixel's width is that parallel to the plane: the most that a cone
// moves there by a shift of its contour of 1 px.
struct Spot {
  Vector2d position;       // of its centre
  double radius_px = 0.0;  // all of it is within this
  double least_mm_per_px = 0.0, most_mm_per_px = 0.0;
};

// Nothing for a ball that reaches the camera's plane.
std::optional<Spot> SpotOf(const VisualHull& hull, core::CameraIndex camera, const core::Ball& ball) {
  const Vector3d x_in_cam = hull.rig().cameras[camera].cam_from_world() * ball.center;
  const double z = x_in_cam.z(), r = ball.radius_mm;
  if (!(z > r)) return std::nullopt;
  const double focal_px = hull.silhouettes()[camera]->plane().focal_px();
  return Spot{x_in_cam.head<2>() * (focal_px / z), focal_px * r * x_in_cam.norm() / (z * (z - r)),
              (z - r) / focal_px, (z + r) / focal_px};
}

bool IsMoving(const CameraLook& look) {
  return look.skew_s > 0.0 && !(look.motion && look.motion->is_still());
}

}  // namespace

SkewErrors::SkewErrors(std::vector<std::optional<CameraLook>> looks) : looks_(std::move(looks)) {
  is_still_ = std::ranges::none_of(looks_, [](const auto& look) { return look && IsMoving(*look); });
}

// The speed that a contour near the ball had on the mean of the last period, mm/s, and how much that changed
// from the period before it, mm/s². Where nothing is known of that one, it was at rest then.
struct SkewErrors::Seen {
  double mm_per_s = 0.0;
  double mm_per_s2 = 0.0;
  bool is_moving = false;
};

SkewErrors::Seen SkewErrors::SeenBy(const VisualHull& hull, core::CameraIndex camera,
                                    const core::Ball& ball_in_world) const {
  const std::optional<CameraLook>& look = looks_[camera];
  if (!look || !look->motion) return {};
  const std::optional<Spot> spot = SpotOf(hull, camera, ball_in_world);
  if (!spot) return {};
  const double share = core::kCoverageFactor * look->skew_s / look->period_s;
  const double moved_px = look->motion->MostNear(spot->position, spot->radius_px, share);
  // What is here now was up to two periods' way from here then.
  const double before_px =
      look->motion_before ? look->motion_before->MostNear(spot->position, spot->radius_px, 2.0) : 0.0;
  Seen seen;
  seen.is_moving = moved_px >= kStillPx;
  seen.mm_per_s = spot->most_mm_per_px * moved_px / look->period_s;
  const double before_mm_per_s =
      look->motion_before ? spot->most_mm_per_px * before_px / look->period_before_s : 0.0;
  seen.mm_per_s2 = std::abs(seen.mm_per_s - before_mm_per_s) / look->period_s;
  return seen;
}

// One camera may look just before a motion begins that another sees: the largest acceleration that any of
// them sees counts for all.
double SkewErrors::AccelerationNear(const VisualHull& hull, const core::Ball& ball_in_world) const {
  double mm_per_s2 = 0.0;
  for (core::CameraIndex camera = 0; camera < looks_.size(); ++camera) {
    const Seen seen = SeenBy(hull, camera, ball_in_world);
    mm_per_s2 = std::max({mm_per_s2, seen.mm_per_s2, seen.is_moving ? kHandMmPerS2 : 0.0});
  }
  return mm_per_s2;
}

// The speed is the mean of the last period. In the time from the camera's instant to the frame's, an
// acceleration a adds a |t_i - t| (period + |t_i - t|) / 2 to its way at most.
double SkewErrors::ShiftMm(const VisualHull& hull, core::CameraIndex camera, const core::Ball& ball_in_world,
                           double mm_per_s2) const {
  const std::optional<CameraLook>& look = looks_[camera];
  if (!look || !(look->skew_s > 0.0)) return 0.0;
  const double fastest_mm = kFastestMmPerS * look->skew_s;
  if (!look->motion || !SpotOf(hull, camera, ball_in_world)) return fastest_mm;
  const double even_mm = SeenBy(hull, camera, ball_in_world).mm_per_s * look->skew_s;
  const double accelerated_mm = 0.5 * mm_per_s2 * look->skew_s * (look->period_s + look->skew_s);
  return std::min(even_mm + accelerated_mm, fastest_mm);
}

double SkewErrors::AtMm(const VisualHull& hull, const Vector3d& x_of_hull, const Vector3d& x_of_part) const {
  if (is_still_) return 0.0;
  const std::vector<SurfaceBound> bounds = SurfaceBoundsAt(hull, x_of_hull);
  std::vector<Vector3d> normals;
  for (const SurfaceBound& bound : bounds) normals.push_back(bound.normal_in_world);
  const auto shares = SharesOf(normals, (x_of_part - x_of_hull).normalized());
  if (!shares) return WorstInMm(hull, {x_of_hull, kNeighbourhoodMm});
  const core::Ball near{x_of_hull, kNeighbourhoodMm};
  const double mm_per_s2 = AccelerationNear(hull, near);
  double sum_mm = 0.0;
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (bounds[i].edge) sum_mm += (*shares)[i] * ShiftMm(hull, bounds[i].edge->camera, near, mm_per_s2);
  return sum_mm;
}

double SkewErrors::WorstInMm(const VisualHull& hull, const core::Ball& ball_in_world) const {
  double worst_mm = 0.0;
  if (is_still_) return worst_mm;
  const double mm_per_s2 = AccelerationNear(hull, ball_in_world);
  for (core::CameraIndex camera = 0; camera < looks_.size(); ++camera)
    worst_mm = std::max(worst_mm, ShiftMm(hull, camera, ball_in_world, mm_per_s2));
  return worst_mm;
}

bool SkewErrors::StaysFarther(const VisualHull& hull, const core::TriangleTree& part,
                              const core::RigidTransform& world_from_part, double distance_mm,
                              double finest_mm) const {
  if (is_still_ || part.nodes().empty()) return true;
  const core::Ball& of_part = part.nodes()[0].ball;
  const core::Ball ball{world_from_part * of_part.center, of_part.radius_mm + distance_mm};
  const double mm_per_s2 = AccelerationNear(hull, ball);
  std::vector<double> margins_px;
  for (core::CameraIndex camera = 0; camera < looks_.size(); ++camera) {
    const std::optional<Spot> spot = SpotOf(hull, camera, ball);
    const double margin_mm = core::kCoverageFactor * ShiftMm(hull, camera, ball, mm_per_s2);
    // The silhouette of a missing camera is all object.
    margins_px.push_back(looks_[camera] && spot ? margin_mm / spot->least_mm_per_px : core::kInfinity);
  }
  return SweptMargins(hull, std::move(margins_px)).Exclude(part, world_from_part, distance_mm, finest_mm);
}

}  // namespace elbowroom::recon
