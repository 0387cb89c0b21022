#include "app/console/view/handle_lines.h"

#include <QLineF>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace elbowroom::console {
namespace {

constexpr int kRingPieces = 48;

}  // namespace

std::optional<double> HandleLengthMm(const recon::SceneView& view, const Eigen::Vector3d& at_in_world) {
  const double depth_mm = (view.cam_from_world * at_in_world).z();
  if (!(depth_mm > view.near_mm)) return std::nullopt;
  return kHandlePx * depth_mm / view.focal_px;
}

std::vector<Eigen::Vector3d> ArrowAlong(const Eigen::Vector3d& at_in_world,
                                        const Eigen::Vector3d& direction_in_world, double length_mm) {
  return {at_in_world + 0.15 * length_mm * direction_in_world, at_in_world + length_mm * direction_in_world};
}

std::vector<Eigen::Vector3d> RingAcross(const Eigen::Vector3d& at_in_world,
                                        const Eigen::Vector3d& first_in_world,
                                        const Eigen::Vector3d& second_in_world, double length_mm) {
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i <= kRingPieces; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRingPieces;
    ring.push_back(at_in_world + kHandleRingShare * length_mm *
                                     (std::cos(angle) * first_in_world + std::sin(angle) * second_in_world));
  }
  return ring;
}

QPolygonF Projected(const recon::SceneView& view, const std::vector<Eigen::Vector3d>& line) {
  QPolygonF projected;
  for (const Eigen::Vector3d& x : line)
    if (const auto pixel = view.Project(x)) projected << QPointF(pixel->x() + 0.5, pixel->y() + 0.5);
  return projected;
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

std::optional<QPointF> GripOf(const QPolygonF& line, bool is_ring) {
  if (line.isEmpty()) return std::nullopt;
  return is_ring ? line[line.size() / 8] : 0.25 * line.front() + 0.75 * line.back();
}

void PaintHandle(QPainter& painter, const QPolygonF& line, bool is_ring, const QColor& ink, bool is_hot) {
  if (line.isEmpty()) return;
  painter.setPen(QPen(is_hot ? ink.lighter(150) : ink, is_hot ? 4.0 : is_ring ? 1.5 : 2.5));
  painter.drawPolyline(line);
  if (is_ring) return;
  painter.setBrush(painter.pen().color());
  painter.drawEllipse(line.back(), 4.0, 4.0);
  painter.setBrush(Qt::NoBrush);
}

}  // namespace elbowroom::console
