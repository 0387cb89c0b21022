#include "app/console/view/dimension_painter.h"

#include <QFontMetrics>
#include <QLineF>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "app/control/palette/part_colors.h"

namespace elbowroom::console {
namespace {

const QColor kMeasured(0, 90, 160);
constexpr double kMarkPx = 4.0;
constexpr double kBesideLinePx = 6.0;

QColor ColorOf(const control::Dimension& dimension) {
  if (!dimension.band) return kMeasured;
  const control::Color color = control::BandColor(*dimension.band);
  return QColor::fromRgbF(color.x(), color.y(), color.z());
}

// The sign stands for the colour, for those who don't see it.
QString TextOf(const control::Dimension& dimension) {
  const QString text = QString::fromStdString(dimension.text);
  if (!dimension.band) return text;
  switch (*dimension.band) {
    case core::Verdict::kContact:
      return "✕ " + text;
    case core::Verdict::kNear:
      return "▲ " + text;
    case core::Verdict::kClear:
      return "✓ " + text;
    case core::Verdict::kUndecided:
      return "? " + text;
  }
  return text;
}

// To the nearest place above or below in the room that is over no mark and no other text; where there is none
// it stays.
void MoveToFreePlace(QRectF* plate, const QRectF& room, const std::vector<QRectF>& taken) {
  constexpr double kStepPx = 3.0;
  const double farthest_px = 12.0 * plate->height();
  for (double away_px = 0.0; away_px < farthest_px; away_px += kStepPx) {
    for (const double down_px : {-away_px, away_px}) {
      const QRectF place = plate->translated(0, down_px);
      const bool is_free =
          std::ranges::none_of(taken, [&](const QRectF& other) { return other.intersects(place); });
      if (!is_free || !room.contains(place)) continue;
      *plate = place;
      return;
    }
  }
}

// Where the text of a line is written that has its middle at `at`.
QRectF PlaceText(const QPainter& painter, const QPointF& at, const QString& text,
                 std::vector<QRectF>* taken) {
  const QFontMetrics metrics = painter.fontMetrics();
  QRectF plate(0, 0, metrics.horizontalAdvance(text) + 10, metrics.height() + 4);
  plate.moveCenter(at - QPointF(0, 0.5 * plate.height() + kBesideLinePx));
  const QRectF room = painter.viewport();
  plate.moveLeft(std::clamp(plate.left(), 2.0, std::max(2.0, room.width() - plate.width() - 2)));
  plate.moveTop(std::clamp(plate.top(), 2.0, std::max(2.0, room.height() - plate.height() - 2)));
  MoveToFreePlace(&plate, room, *taken);
  taken->push_back(plate);
  return plate;
}

// From the middle of a line to its text, where that had to go farther away.
void PaintLeader(QPainter& painter, const QPointF& at, const QRectF& plate, const QColor& color) {
  const QPointF end(std::clamp(at.x(), plate.left(), plate.right()),
                    std::clamp(at.y(), plate.top(), plate.bottom()));
  const QLineF leader(at, end);
  if (leader.length() <= 2.0 * kBesideLinePx) return;
  painter.setPen(QPen(color, 1.0, Qt::DotLine));
  painter.drawLine(leader);
}

void PaintText(QPainter& painter, const QRectF& plate, const QString& text, const QColor& color) {
  painter.setPen(QPen(color, 1.5));
  painter.setBrush(QColor(255, 255, 255, 225));
  painter.drawRoundedRect(plate, 3, 3);
  painter.setPen(QColor(20, 24, 29));
  painter.drawText(plate, Qt::AlignCenter, text);
}

void PaintLine(QPainter& painter, const QLineF& line, const QColor& color) {
  painter.setPen(QPen(QColor(20, 24, 29, 160), 4.0, Qt::SolidLine, Qt::RoundCap));  // seen on any picture
  painter.drawLine(line);
  painter.setPen(QPen(color, 2.0, Qt::SolidLine, Qt::RoundCap));
  painter.drawLine(line);
  painter.setPen(QPen(QColor(20, 24, 29), 1.0));
  painter.setBrush(color);
  for (const QPointF& end : {line.p1(), line.p2()}) painter.drawEllipse(end, kMarkPx, kMarkPx);
}

QRectF MarkAt(const QPointF& end) {
  return QRectF(end - QPointF(kMarkPx, kMarkPx), end + QPointF(kMarkPx, kMarkPx));
}

}  // namespace

void PaintDimensions(QPainter& painter, const recon::SceneView& view, const QPoint& origin,
                     std::span<const control::Dimension> dimensions) {
  struct Shown {
    QLineF line;
    QString text;
    QColor color;
    QRectF plate;
  };
  std::vector<Shown> shown;
  for (const control::Dimension& dimension : dimensions) {
    const std::optional<Eigen::Vector2d> from = view.Project(dimension.from_in_world),
                                         to = view.Project(dimension.to_in_world);
    if (!from || !to) continue;
    const auto in_widget = [&](const Eigen::Vector2d& pixel) {
      return QPointF(origin) + QPointF(pixel.x() + 0.5, pixel.y() + 0.5);
    };
    shown.push_back({{in_widget(*from), in_widget(*to)}, TextOf(dimension), ColorOf(dimension), {}});
  }
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  std::vector<QRectF> taken;  // by marks and texts
  for (const Shown& dimension : shown) {
    PaintLine(painter, dimension.line, dimension.color);
    taken.push_back(MarkAt(dimension.line.p1()));
    taken.push_back(MarkAt(dimension.line.p2()));
  }
  for (Shown& dimension : shown) {
    dimension.plate = PlaceText(painter, dimension.line.center(), dimension.text, &taken);
    PaintLeader(painter, dimension.line.center(), dimension.plate, dimension.color);
  }
  for (const Shown& dimension : shown) PaintText(painter, dimension.plate, dimension.text, dimension.color);
  painter.restore();
}

}  // namespace elbowroom::console
