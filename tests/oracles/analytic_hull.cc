#include "tests/oracles/analytic_hull.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace elbowroom::oracles {
namespace {

using Eigen::Vector3d;
using recon::BoundingSphere;

constexpr double kConeSlack = 1e-9;  // for the rounding of the coarse test

// Balls of one size along z that cover a cylinder with round ends (`cap_mm`: how far those reach beyond).
std::vector<BoundingSphere> AlongAxis(const core::RigidTransform& world_from_solid, double radius_mm,
                                      double length_mm, double cap_mm) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(length_mm / radius_mm)));
  const double piece_mm = length_mm / pieces;
  const double ball_mm = std::max(std::hypot(radius_mm, 0.5 * piece_mm), 0.5 * piece_mm + cap_mm);
  std::vector<BoundingSphere> balls;
  for (int i = 0; i < pieces; ++i)
    balls.push_back({world_from_solid * Vector3d(0.0, 0.0, (i + 0.5) * piece_mm), ball_mm});
  return balls;
}

}  // namespace

std::vector<BoundingSphere> CoveringBalls(const recon::Solid& solid) {
  const core::RigidTransform& pose = solid.world_from_solid;
  if (const auto* capsule = std::get_if<recon::Capsule>(&solid.shape)) {
    return AlongAxis(pose, capsule->radius_mm, capsule->length_mm, capsule->radius_mm);
  }
  if (const auto* tube = std::get_if<recon::Tube>(&solid.shape)) {
    return AlongAxis(pose, tube->outer_radius_mm, tube->length_mm, 0.0);
  }
  return {recon::BoundingSphereOf(solid)};
}

std::vector<Sight> AnalyticHull::SightsOf(const core::Rig& rig, std::span<const recon::Solid> solids) {
  std::vector<Sight> sights;
  for (const core::CameraModel& camera : rig.cameras)
    sights.push_back({camera, camera.cam_from_world(), {solids.begin(), solids.end()}});
  return sights;
}

AnalyticHull::AnalyticHull(const core::Rig& rig, std::span<const recon::Solid> solids)
    : AnalyticHull(rig.workspace_mm, rig.unseen, SightsOf(rig, solids)) {}

AnalyticHull::AnalyticHull(const Eigen::AlignedBox3d& workspace_mm, core::UnseenPolicy unseen,
                           std::vector<Sight> sights)
    : workspace_mm_(workspace_mm), unseen_(unseen) {
  for (Sight& sight : sights) {
    const core::RigidTransform world_from_cam = sight.true_cam_from_world.Inverse();
    Eye eye{std::move(sight), {}, world_from_cam.translation_mm, {}};
    eye.seen_from_world = world_from_cam * eye.sight.believed.cam_from_world();
    for (const recon::Solid& solid : eye.sight.solids) {
      for (const BoundingSphere& ball : CoveringBalls(solid))
        eye.cones.push_back(ConeAround(eye.center_in_world, ball));
    }
    eyes_.push_back(std::move(eye));
  }
}

AnalyticHull::Cone AnalyticHull::ConeAround(const Vector3d& eye, const BoundingSphere& ball) {
  const Vector3d to_ball = ball.center_in_world - eye;
  const double distance_mm = to_ball.norm();
  if (distance_mm <= ball.radius_mm) return {Vector3d::UnitZ(), std::numbers::pi, -1.0, 0.0};
  const double sine = ball.radius_mm / distance_mm;
  return {to_ball / distance_mm, std::asin(sine), std::sqrt(1.0 - sine * sine), sine};
}

bool AnalyticHull::MayShareARay(const Cone& a, const Cone& b) {
  if (a.half_angle_rad + b.half_angle_rad >= std::numbers::pi) return true;
  const double cos_sum = a.cos_half_angle * b.cos_half_angle - a.sin_half_angle * b.sin_half_angle;
  return a.axis_in_world.dot(b.axis_in_world) >= cos_sum - kConeSlack;
}

bool AnalyticHull::Contains(const Vector3d& x_in_world) const {
  if (!workspace_mm_.contains(x_in_world)) return false;
  bool is_seen = false;
  for (const Eye& eye : eyes_) {
    const core::CameraModel& camera = eye.sight.believed;
    const auto pixel = camera.Project(x_in_world);
    const bool is_in_picture = pixel && pixel->x() >= -0.5 && pixel->x() < camera.width_px() - 0.5 &&
                               pixel->y() >= -0.5 && pixel->y() < camera.height_px() - 0.5;
    if (!is_in_picture) {
      if (unseen_ == core::UnseenPolicy::kOutside) return false;
      continue;
    }
    is_seen = true;
    const recon::Ray sight_ray{eye.center_in_world,
                               (eye.seen_from_world * x_in_world - eye.center_in_world).normalized()};
    const bool is_hit = std::ranges::any_of(eye.sight.solids, [&](const recon::Solid& solid) {
      return recon::FirstHit(solid, sight_ray).has_value();
    });
    if (!is_hit) return false;
  }
  return is_seen;
}

bool AnalyticHull::IsEmpty(const Vector3d& a_in_world, const Vector3d& b_in_world) const {
  if (unseen_ == core::UnseenPolicy::kAbstain) return false;
  const double half_mm = 0.5 * (b_in_world - a_in_world).norm();
  return std::ranges::any_of(eyes_, [&](const Eye& eye) {
    const Vector3d middle = eye.seen_from_world * (0.5 * (a_in_world + b_in_world));
    const Cone stretch = ConeAround(eye.center_in_world, {middle, half_mm});
    return std::ranges::none_of(eye.cones, [&](const Cone& cone) { return MayShareARay(stretch, cone); });
  });
}

std::optional<double> AnalyticHull::FirstSurface(const recon::Ray& ray, const MarchOptions& options) const {
  const auto span = ClipToBox(workspace_mm_, ray, options.from_mm);
  if (!span) return std::nullopt;
  const auto at = [&](long double t) -> Vector3d { return PointAt(ray, t).cast<double>(); };
  return FirstAlong(
      span->first, span->second, options.step_mm, [&](long double t) { return Contains(at(t)); },
      [&](long double t0, long double t1) { return IsEmpty(at(t0), at(t1)); });
}

}  // namespace elbowroom::oracles
