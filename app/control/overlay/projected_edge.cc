#include "app/control/overlay/projected_edge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace elbowroom::control {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A stretch of a segment, from 0 at its begin to 1 at its end.
struct Stretch {
  double from = 0.0;
  double to = 1.0;
  [[nodiscard]] bool is_empty() const { return !(from < to); }
};

// Cuts off where value(s) = at_begin + s * slope is below 0.
void KeepNotNegative(double at_begin, double slope, Stretch* stretch) {
  if (slope == 0.0) {
    if (at_begin < 0.0) stretch->to = stretch->from;
    return;
  }
  const double zero = -at_begin / slope;
  if (slope > 0.0) {
    stretch->from = std::max(stretch->from, zero);
  } else {
    stretch->to = std::min(stretch->to, zero);
  }
}

Stretch WithinBox(const Eigen::AlignedBox2d& box, const Vector2d& from, const Vector2d& step) {
  Stretch stretch;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    KeepNotNegative(from[axis] - box.min()[axis], step[axis], &stretch);
    KeepNotNegative(box.max()[axis] - from[axis], -step[axis], &stretch);
  }
  return stretch;
}

// The part of the stretch within the disc about the origin: |from + s * step|² <= radius².
Stretch WithinDisc(double radius, const Vector2d& from, const Vector2d& step, Stretch stretch) {
  const double a = step.squaredNorm(), half_b = from.dot(step), c = from.squaredNorm() - radius * radius;
  if (a == 0.0) return c <= 0.0 ? stretch : Stretch{0.0, 0.0};
  const double discriminant = half_b * half_b - a * c;
  if (discriminant <= 0.0) return {0.0, 0.0};
  const double root = std::sqrt(discriminant);
  stretch.from = std::max(stretch.from, (-half_b - root) / a);
  stretch.to = std::min(stretch.to, (-half_b + root) / a);
  return stretch;
}

}  // namespace

std::vector<CurvePoint> ProjectEdge(const core::CameraModel& camera, const Eigen::AlignedBox2d& frame,
                                    const Vector3d& a_in_cam, const Vector3d& b_in_cam) {
  Stretch before;
  KeepNotNegative(a_in_cam.z() - kOverlayNearMm, b_in_cam.z() - a_in_cam.z(), &before);
  if (before.is_empty()) return {};
  const Vector3d along = b_in_cam - a_in_cam;
  const Vector3d a = a_in_cam + before.from * along, b = a_in_cam + before.to * along;
  const Vector2d from = a.head<2>() / a.z(), step = Vector2d(b.head<2>() / b.z()) - from;
  // The largest radius itself is left out: rounding may put a point beyond it.
  const Stretch seen =
      WithinDisc(camera.max_radius() * (1.0 - 1e-9), from, step, WithinBox(frame, from, step));
  if (seen.is_empty()) return {};
  const double reach = std::max((from + seen.from * step).norm(), (from + seen.to * step).norm());
  const double length_px = (seen.to - seen.from) * step.norm() * camera.PixelStretch(reach);
  const int pieces = std::max(1, static_cast<int>(std::ceil(length_px)));
  std::vector<CurvePoint> curve;
  curve.reserve(static_cast<std::size_t>(pieces) + 1);
  for (int i = 0; i <= pieces; ++i) {
    const double s = seen.from + (seen.to - seen.from) * i / pieces;
    const Vector2d normalised = from + s * step;
    const double depth_mm = 1.0 / ((1.0 - s) / a.z() + s / b.z());  // 1/z is linear in the picture
    curve.push_back({camera.PixelFromNormalised(normalised), depth_mm, depth_mm * normalised.homogeneous()});
  }
  return curve;
}

}  // namespace elbowroom::control
