#include "app/console/layouts/part_gizmo.h"

#include <cmath>
#include <numbers>

#include "app/console/view/handle_lines.h"
#include "core/units.h"

namespace elbowroom::console {
namespace {

constexpr double kStepMm = 1.0, kStepDeg = 5.0;

QColor AxisInk(int axis) {
  constexpr std::array<QRgb, 3> kInks = {0xffc4342c, 0xff2e7d32, 0xff215db0};
  return QColor::fromRgb(kInks.at(static_cast<std::size_t>(axis)));
}

}  // namespace

PartGizmo::PartGizmo(const recon::SceneView& view, const Eigen::Vector3d& center_in_world,
                     const std::array<bool, 3>& may_move) {
  const std::optional<double> length_mm = HandleLengthMm(view, center_in_world);
  if (!length_mm) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (may_move.at(static_cast<std::size_t>(axis)))
      drawn_.push_back(
          {{false, axis},
           Projected(view, ArrowAlong(center_in_world, Eigen::Vector3d::Unit(axis), *length_mm))});
    drawn_.push_back({{true, axis},
                      Projected(view, RingAcross(center_in_world, Eigen::Vector3d::Unit((axis + 1) % 3),
                                                 Eigen::Vector3d::Unit((axis + 2) % 3), *length_mm))});
  }
}

// Of a line and a ring that are equally near, the line, which comes before.
std::optional<GizmoHandle> PartGizmo::HandleAt(const QPointF& position) const {
  std::optional<GizmoHandle> handle;
  double least = kHandleReachPx;
  for (const bool is_ring : {false, true}) {
    for (const Drawn& drawn : drawn_) {
      if (drawn.handle.is_ring != is_ring) continue;
      const double distance = DistanceTo(drawn.line, position);
      if (distance >= least) continue;
      least = distance;
      handle = drawn.handle;
    }
  }
  return handle;
}

std::optional<QPointF> PartGizmo::MiddleOf(const GizmoHandle& handle) const {
  for (const Drawn& drawn : drawn_)
    if (drawn.handle == handle) return GripOf(drawn.line, handle.is_ring);
  return std::nullopt;
}

void PartGizmo::Paint(QPainter& painter, const std::optional<GizmoHandle>& hot) const {
  for (const Drawn& drawn : drawn_)
    PaintHandle(painter, drawn.line, drawn.handle.is_ring, AxisInk(drawn.handle.axis), hot == drawn.handle);
}

std::optional<double> GizmoDrag::ValueOf(const control::PickRay& ray) const {
  return handle_.is_ring ? control::DirectionAbout(axis_, ray) : control::NearestAlong(axis_, ray);
}

std::optional<GizmoDrag> GizmoDrag::Begin(const GizmoHandle& handle, const Eigen::Vector3d& center_in_world,
                                          const core::RigidTransform& world_from_part,
                                          const control::PickRay& ray) {
  GizmoDrag drag;
  drag.handle_ = handle;
  drag.axis_ = {center_in_world, Eigen::Vector3d::Unit(handle.axis)};
  drag.start_ = world_from_part;
  const std::optional<double> first = drag.ValueOf(ray);
  if (!first) return std::nullopt;
  drag.first_ = *first;
  return drag;
}

core::RigidTransform GizmoDrag::At(const control::PickRay& ray, bool in_steps) const {
  const std::optional<double> value = ValueOf(ray);
  if (!value) return start_;
  if (handle_.is_ring) {
    const double step_rad = in_steps ? core::RadiansFromDegrees(kStepDeg) : 0.0;
    const double angle = std::remainder(*value - first_, 2.0 * std::numbers::pi);
    return control::TurnedAbout(axis_, control::Snapped(angle, step_rad), start_);
  }
  core::RigidTransform moved = start_;
  moved.translation_mm +=
      control::Snapped(*value - first_, in_steps ? kStepMm : 0.0) * axis_.direction_in_world;
  return moved;
}

}  // namespace elbowroom::console
