#include "recon/coverage/ball_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace elbowroom::recon {
namespace {

using Eigen::Vector3d;

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

struct GaussNode {
  double at = 0.0;  // in 0..1
  double weight = 0.0;
};

// Gauss and Legendre's rule on 0..1, by Newton's method on Legendre's polynomial.
std::vector<GaussNode> GaussRule(int count) {
  std::vector<GaussNode> rule;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1.0;
    constexpr int kSteps = 8;
    for (int step = 0; step < kSteps; ++step) {
      double before = 1.0, now = x;
      for (int n = 2; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
        before = now;
        now = next;
      }
      slope = count * (x * now - before) / (x * x - 1.0);
      x -= now / slope;
    }
    rule.push_back({0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)});
  }
  return rule;
}

// t with (axis . y)^2 >= cos2 |y|^2 and axis . y >= 0, for y = offset + t along: one stretch, as a cone is
// convex.
Stretch InCone(const Vector3d& axis, double cos2, const Vector3d& offset, const Vector3d& along) {
  const double along_axis = along.dot(axis), offset_axis = offset.dot(axis);
  const double a = along_axis * along_axis - cos2, b = offset_axis * along_axis - cos2 * offset.dot(along),
               c = offset_axis * offset_axis - cos2 * offset.squaredNorm();
  const double root2 = b * b - a * c;
  if (a < 0.0) {  // the ray leaves the cone at both ends; both are on the same half of the double cone
    if (!(root2 > 0.0)) return {0.0, 0.0};
    const double root = std::sqrt(root2), first = (-b + root) / a, last = (-b - root) / a;
    if (offset_axis + 0.5 * (first + last) * along_axis < 0.0) return {0.0, 0.0};
    return {std::max(first, 0.0), last};
  }
  // The ray ends in the cone, or in its mirror image.
  const double root = std::sqrt(std::max(root2, 0.0));
  // The root without a difference of nearly equal numbers; the other one by the product c / a.
  const double far = b > 0.0 ? -b - root : -b + root;
  const double one = a > 0.0 ? far / a : kNoEnd, other = far != 0.0 ? c / far : 0.0;
  if (a > 0.0)
    return along_axis > 0.0 ? Stretch{std::max({one, other, 0.0}), kNoEnd}
                            : Stretch{0.0, std::min(one, other)};
  return b > 0.0 ? Stretch{std::max(other, 0.0), kNoEnd} : Stretch{0.0, other};
}

Stretch InBall(const Vector3d& center_from_start, double radius_mm, const Vector3d& along) {
  const double middle = center_from_start.dot(along);
  const double half2 = radius_mm * radius_mm - (center_from_start - middle * along).squaredNorm();
  if (!(half2 > 0.0)) return {0.0, 0.0};
  const double half = std::sqrt(half2);
  return {std::max(middle - half, 0.0), middle + half};
}

Stretch InBox(const Eigen::AlignedBox3d& box, const Vector3d& start, const Vector3d& along) {
  Stretch stretch;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double to_min = box.min()[axis] - start[axis], to_max = box.max()[axis] - start[axis];
    if (along[axis] == 0.0) {
      if (to_min > 0.0 || to_max < 0.0) return {0.0, 0.0};
      continue;
    }
    const double a = to_min / along[axis], b = to_max / along[axis];
    stretch = {std::max(stretch.begin, std::min(a, b)), std::min(stretch.end, std::max(a, b))};
  }
  return stretch;
}

}  // namespace

BallHull::BallHull(const core::Rig& rig, int rings)
    : workspace_mm_(rig.workspace_mm), abstains_(rig.unseen == core::UnseenPolicy::kAbstain) {
  core::Require(rings >= 2 && rings <= 40, "a cone has 2 to 40 rings of rays");
  for (const core::CameraModel& camera : rig.cameras)
    eyes_.push_back({camera.cam_from_world(), camera.center_in_world(), PictureRegion(camera)});
  const int around = 2 * rings + 2;
  const std::vector<GaussNode> rule = GaussRule(rings);
  for (std::size_t ring = 0; ring < rule.size(); ++ring) {
    for (int i = 0; i < around; ++i) {
      // Every ring is turned by the golden share of a step against the last, so that no direction is missed.
      constexpr double kGolden = 0.6180339887498949;
      const double turn = 2.0 * std::numbers::pi * (i + kGolden * static_cast<double>(ring)) / around;
      pattern_.push_back({rule[ring].at, std::cos(turn), std::sin(turn), rule[ring].weight / around});
    }
  }
}

std::optional<BallHullVolume> BallHull::At(const Vector3d& center_mm, double radius_mm,
                                           Scratch* scratch) const {
  if (!workspace_mm_.contains(center_mm) || !SetCones(center_mm, radius_mm, scratch)) return std::nullopt;
  BallHullVolume volume;
  if (abstains_) {
    for (std::size_t eye = 0; eye < eyes_.size(); ++eye) AddCone(eye, center_mm, radius_mm, scratch, &volume);
  } else {
    AddCone(0, center_mm, radius_mm, scratch, &volume);
  }
  if (!(volume.hull_mm3 > 0.0)) return std::nullopt;
  return volume;
}

bool BallHull::SetCones(const Vector3d& center_mm, double radius_mm, Scratch* scratch) const {
  scratch->cones.resize(eyes_.size());
  std::size_t seeing = 0;
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    const Vector3d to_ball = center_mm - eyes_[i].center_mm;
    const double distance2 = to_ball.squaredNorm();
    if (!(distance2 > radius_mm * radius_mm)) return false;
    const Vector3d center_in_cam = eyes_[i].cam_from_world * center_mm;
    seeing += eyes_[i].region.Holds(center_in_cam) ? 1 : 0;
    scratch->cones[i] = {to_ball / std::sqrt(distance2), 1.0 - radius_mm * radius_mm / distance2,
                         eyes_[i].region.SurelyHoldsBall(center_in_cam, radius_mm)};
  }
  return abstains_ ? seeing > 0 : seeing == eyes_.size();
}

void BallHull::AddCone(std::size_t eye, const Vector3d& center_mm, double radius_mm, Scratch* scratch,
                       BallHullVolume* volume) const {
  const Scratch::Cone& cone = scratch->cones[eye];
  const Vector3d& start = eyes_[eye].center_mm;
  const Vector3d across = cone.axis.unitOrthogonal(), other = cone.axis.cross(across);
  // 1 - cos of the half angle, without a difference of nearly equal numbers.
  const double cap = (1.0 - cone.cos2) / (1.0 + std::sqrt(cone.cos2));
  const double solid_angle = 2.0 * std::numbers::pi * cap;
  for (const PatternRay& ray : pattern_) {
    const double rise = ray.out * cap, sine = std::sqrt(rise * (2.0 - rise));
    const Vector3d along =
        ((1.0 - rise) * cone.axis + sine * (ray.cos_around * across + ray.sin_around * other)).normalized();
    const WorldRay world_ray{start, along};
    scratch->stretches.Clear();
    scratch->stretches.Append(InBox(workspace_mm_, start, along));
    if (abstains_) {
      CutAbstaining(eye, world_ray, scratch);
    } else {
      CutOutside(eye, world_ray, scratch);
    }
    const double weight = ray.weight * solid_angle;
    volume->hull_mm3 += weight * scratch->stretches.VolumePerSteradian();
    volume->ball_mm3 +=
        weight * scratch->stretches.VolumePerSteradian(InBall(center_mm - start, radius_mm, along));
  }
}

// In the hull is what every camera has in its picture and in its cone.
void BallHull::CutOutside(std::size_t from, const WorldRay& ray, Scratch* scratch) const {
  for (std::size_t i = 0; i < eyes_.size() && !scratch->stretches.is_empty(); ++i)
    if (i != from) scratch->stretches.Keep(ConeStretch(i, ray, *scratch));
  // The hull's image lies within the ball's, so a picture that holds the ball cuts nothing.
  for (std::size_t i = 0; i < eyes_.size() && !scratch->stretches.is_empty(); ++i)
    if (!scratch->cones[i].surely_in_picture) CutBySight(i, ray, scratch);
}

// In the hull is what some camera sees and none refutes. Each point is counted on a ray of the first camera
// that sees it.
void BallHull::CutAbstaining(std::size_t from, const WorldRay& ray, Scratch* scratch) const {
  if (!scratch->cones[from].surely_in_picture &&
      !eyes_[from].region.Holds(eyes_[from].cam_from_world.rotation * ray.along)) {
    scratch->stretches.Clear();
    return;
  }
  for (std::size_t i = 0; i < from && !scratch->stretches.is_empty(); ++i) RemoveSeen(i, ray, scratch);
  for (std::size_t i = from + 1; i < eyes_.size() && !scratch->stretches.is_empty(); ++i)
    RemoveRefuted(i, ray, scratch);
}

Stretch BallHull::ConeStretch(std::size_t eye, const WorldRay& ray, const Scratch& scratch) const {
  const Scratch::Cone& cone = scratch.cones[eye];
  return InCone(cone.axis, cone.cos2, ray.start - eyes_[eye].center_mm, ray.along);
}

namespace {

Stretch SpanOf(const RayStretches& stretches) {
  return {stretches.all().front().begin, stretches.all().back().end};
}

}  // namespace

void BallHull::CutBySight(std::size_t eye, const WorldRay& ray, Scratch* scratch) const {
  const core::RigidTransform& cam_from_world = eyes_[eye].cam_from_world;
  eyes_[eye].region.Cut({cam_from_world * ray.start, cam_from_world.rotation * ray.along},
                        SpanOf(scratch->stretches), &scratch->seen);
  scratch->stretches.Keep(scratch->seen);
}

void BallHull::RemoveSeen(std::size_t eye, const WorldRay& ray, Scratch* scratch) const {
  const core::RigidTransform& cam_from_world = eyes_[eye].cam_from_world;
  eyes_[eye].region.Cut({cam_from_world * ray.start, cam_from_world.rotation * ray.along},
                        SpanOf(scratch->stretches), &scratch->seen);
  for (const Stretch& seen : scratch->seen.all()) scratch->stretches.Remove(seen);
}

void BallHull::RemoveRefuted(std::size_t eye, const WorldRay& ray, Scratch* scratch) const {
  const Stretch cone = ConeStretch(eye, ray, *scratch), span = SpanOf(scratch->stretches);
  if (!cone.is_empty() && cone.begin <= span.begin && cone.end >= span.end) return;
  const core::RigidTransform& cam_from_world = eyes_[eye].cam_from_world;
  eyes_[eye].region.Cut({cam_from_world * ray.start, cam_from_world.rotation * ray.along}, span,
                        &scratch->seen);
  for (const Stretch& seen : scratch->seen.all()) {
    if (cone.is_empty()) {
      scratch->stretches.Remove(seen);
    } else {
      scratch->stretches.Remove({seen.begin, std::min(seen.end, cone.begin)});
      scratch->stretches.Remove({std::max(seen.begin, cone.end), seen.end});
    }
  }
}

}  // namespace elbowroom::recon
