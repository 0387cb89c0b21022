#include "app/console/layouts/part_gizmo.h"

#include <QLineF>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace elbowroom::console {
namespace {

constexpr double kArrowPx = 78.0;
constexpr double kRingShare = 0.72;  // of the arrow
constexpr double kReachPx = 7.0;     // of the pointer
constexpr int kRingPieces = 48;
constexpr double kStepMm = 1.0, kStepDeg = 5.0;

QColor AxisInk(int axis) {
  constexpr std::array<QRgb, 3> kInks = {0xffc4342c, 0xff2e7d32, 0xff215db0};
  return QColor::fromRgb(kInks.at(static_cast<std::size_t>(axis)));
}

double DistanceTo(const QPolygonF& line, const QPointF& position) {
  double least = 1e9;
  for (qsizetype i = 0; i + 1 < line.size(); ++i) {
    const QPointF along = line[i + 1] - line[i], to = position - line[i];
    const double square = QPointF::dotProduct(along, along);
    const double share = square > 0.0 ? std::clamp(QPointF::dotProduct(to, along) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, QLineF(position, line[i] + share * along).length());
  }
  return least;
}

}  // namespace

PartGizmo::PartGizmo(const recon::SceneView& view, const Eigen::Vector3d& center_in_world,
                     const std::array<bool, 3>& may_move) {
  const double depth_mm = (view.cam_from_world * center_in_world).z();
  if (!(depth_mm > view.near_mm)) return;
  const double length_mm = kArrowPx * depth_mm / view.focal_px;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
    if (may_move.at(static_cast<std::size_t>(axis)))
      drawn_.push_back({{false, axis},
                        Projected(view, {center_in_world + 0.15 * length_mm * direction,
                                         center_in_world + length_mm * direction})});
    std::vector<Eigen::Vector3d> ring;
    const Eigen::Vector3d first = Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d second = Eigen::Vector3d::Unit((axis + 2) % 3);
    for (int i = 0; i <= kRingPieces; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kRingPieces;
      ring.push_back(center_in_world +
                     kRingShare * length_mm * (std::cos(angle) * first + std::sin(angle) * second));
    }
    drawn_.push_back({{true, axis}, Projected(view, ring)});
  }
}

QPolygonF PartGizmo::Projected(const recon::SceneView& view, const std::vector<Eigen::Vector3d>& line) const {
  QPolygonF projected;
  for (const Eigen::Vector3d& x : line)
    if (const auto pixel = view.Project(x)) projected << QPointF(pixel->x() + 0.5, pixel->y() + 0.5);
  return projected;
}

// Of a line and a ring that are equally near, the line, which comes before.
std::optional<GizmoHandle> PartGizmo::HandleAt(const QPointF& position) const {
  std::optional<GizmoHandle> handle;
  double least = kReachPx;
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
  for (const Drawn& drawn : drawn_) {
    if (drawn.handle != handle || drawn.line.isEmpty()) continue;
    return handle.is_ring ? drawn.line[drawn.line.size() / 8]
                          : 0.25 * drawn.line.front() + 0.75 * drawn.line.back();
  }
  return std::nullopt;
}

void PartGizmo::Paint(QPainter& painter, const std::optional<GizmoHandle>& hot) const {
  for (const Drawn& drawn : drawn_) {
    if (drawn.line.isEmpty()) continue;
    const bool is_hot = hot == drawn.handle;
    const QColor ink = AxisInk(drawn.handle.axis);
    painter.setPen(QPen(is_hot ? ink.lighter(150) : ink, is_hot ? 4.0 : drawn.handle.is_ring ? 1.5 : 2.5));
    painter.drawPolyline(drawn.line);
    if (drawn.handle.is_ring) continue;
    painter.setBrush(painter.pen().color());
    painter.drawEllipse(drawn.line.back(), 4.0, 4.0);
    painter.setBrush(Qt::NoBrush);
  }
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
