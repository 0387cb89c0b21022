#include "app/console/sights/plane_handles.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "app/console/view/handle_lines.h"
#include "core/units.h"

namespace elbowroom::console {
namespace {

using Eigen::Vector3d;

constexpr std::array kHandles = {PlaneHandle::kNormal, PlaneHandle::kFirstRing, PlaneHandle::kSecondRing};
constexpr double kStepMm = 1.0, kStepDeg = 5.0;

QColor InkOf(PlaneHandle handle) {
  switch (handle) {
    case PlaneHandle::kNormal:
      return QColor::fromRgb(0xff8a3ffc);
    case PlaneHandle::kFirstRing:
      return QColor::fromRgb(0xff00756f);
    case PlaneHandle::kSecondRing:
      return QColor::fromRgb(0xffa05a00);
  }
  return {};
}

}  // namespace

std::optional<PlaneHandles> PlaneHandles::Of(const control::Section& section,
                                             const Eigen::AlignedBox3d& box_in_world) {
  const recon::HalfSpace half_space = control::HalfSpaceOf(section);
  PlaneHandles handles;
  handles.outline_in_world_ = control::OutlineIn(half_space, box_in_world);
  if (handles.outline_in_world_.empty()) return std::nullopt;
  for (const Vector3d& corner : handles.outline_in_world_)
    handles.middle_in_world_ += corner / static_cast<double>(handles.outline_in_world_.size());
  handles.normal_in_world_ = half_space.outward;
  return handles;
}

control::AxisLine PlaneHandles::AxisOf(PlaneHandle handle) const {
  if (handle == PlaneHandle::kNormal) return {middle_in_world_, normal_in_world_};
  const Vector3d across = Vector3d::UnitZ().cross(normal_in_world_);
  const Vector3d level = across.norm() > 1e-6 ? Vector3d(across.normalized()) : Vector3d(Vector3d::UnitX());
  if (handle == PlaneHandle::kFirstRing) return {middle_in_world_, level};
  return {middle_in_world_, normal_in_world_.cross(level)};
}

QPolygonF PlaneHandles::LineOf(const recon::SceneView& view, PlaneHandle handle) const {
  const std::optional<double> length_mm = HandleLengthMm(view, middle_in_world_);
  if (!length_mm) return {};
  const Vector3d axis = AxisOf(handle).direction_in_world;
  if (handle == PlaneHandle::kNormal) return Projected(view, ArrowAlong(middle_in_world_, axis, *length_mm));
  return Projected(view,
                   RingAcross(middle_in_world_, normal_in_world_, axis.cross(normal_in_world_), *length_mm));
}

std::optional<PlaneHandle> PlaneHandles::HandleAt(const recon::SceneView& view,
                                                  const QPointF& position) const {
  std::optional<PlaneHandle> nearest;
  double least = kHandleReachPx;
  for (const PlaneHandle handle : kHandles) {
    const double distance = DistanceTo(LineOf(view, handle), position);
    if (distance >= least) continue;
    least = distance;
    nearest = handle;
  }
  return nearest;
}

std::optional<QPointF> PlaneHandles::GripOn(const recon::SceneView& view, PlaneHandle handle) const {
  return GripOf(LineOf(view, handle), handle != PlaneHandle::kNormal);
}

void PlaneHandles::Paint(QPainter& painter, const recon::SceneView& view,
                         const std::optional<PlaneHandle>& hot) const {
  QPolygonF outline = Projected(view, outline_in_world_);
  if (outline.size() == static_cast<qsizetype>(outline_in_world_.size())) {
    painter.setPen(QPen(InkOf(PlaneHandle::kNormal), 1.0, Qt::DashLine));
    painter.setBrush(Qt::NoBrush);
    painter.drawPolygon(outline);
  }
  for (const PlaneHandle handle : kHandles)
    PaintHandle(painter, LineOf(view, handle), handle != PlaneHandle::kNormal, InkOf(handle), hot == handle);
}

std::optional<double> PlaneDrag::ValueOf(const control::PickRay& ray) const {
  return handle_ == PlaneHandle::kNormal ? control::NearestAlong(axis_, ray)
                                         : control::DirectionAbout(axis_, ray);
}

std::optional<PlaneDrag> PlaneDrag::Begin(PlaneHandle handle, const PlaneHandles& handles,
                                          const control::Section& section, const control::PickRay& ray) {
  PlaneDrag drag;
  drag.handle_ = handle;
  drag.axis_ = handles.AxisOf(handle);
  drag.start_ = section;
  const std::optional<double> first = drag.ValueOf(ray);
  if (!first) return std::nullopt;
  drag.first_ = *first;
  return drag;
}

control::Section PlaneDrag::At(const control::PickRay& ray, bool in_steps) const {
  const std::optional<double> value = ValueOf(ray);
  if (!value) return start_;
  if (handle_ == PlaneHandle::kNormal) {
    control::Section moved = start_;
    moved.offset_mm += control::Snapped(*value - first_, in_steps ? kStepMm : 0.0);
    return moved;
  }
  const double step_rad = in_steps ? core::RadiansFromDegrees(kStepDeg) : 0.0;
  const double angle = control::Snapped(std::remainder(*value - first_, 2.0 * std::numbers::pi), step_rad);
  const Vector3d normal =
      Eigen::AngleAxisd(angle, axis_.direction_in_world) * control::HalfSpaceOf(start_).outward;
  return control::TurnedThrough(start_, normal, axis_.point_in_world);
}

}  // namespace elbowroom::console
