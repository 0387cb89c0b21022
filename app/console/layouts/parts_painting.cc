// What is painted over the picture of the parts.
#include <array>

#include "app/console/desktop/theme.h"
#include "app/console/layouts/part_look.h"
#include "app/console/layouts/parts_view.h"

namespace elbowroom::console {
namespace {

constexpr QColor kGapInk(180, 64, 10);
constexpr double kTickPx = 5.0;

// Corners i and j of a box are the ends of an edge if they differ in one bit.
constexpr std::array<std::array<int, 2>, 12> kBoxEdges = {
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

// On a ground of its own: parts may have any colour.
void PaintLabel(QPainter& painter, const QPointF& at, const QString& text, const QColor& ink) {
  const QRectF words = painter.fontMetrics().boundingRect(text);
  const QRectF ground = words.translated(at).adjusted(-3, -2, 3, 2);
  painter.fillRect(ground, QColor(255, 255, 255, 225));
  painter.setPen(ink);
  painter.drawText(at, text);
}

}  // namespace

void PartsView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), ThemeColors().view_background);
  if (picture_.isNull()) {
    painter.setPen(ThemeColors().quiet_text);
    painter.drawText(rect().adjusted(20, 20, -20, -20), Qt::AlignCenter | Qt::TextWordWrap,
                     scene_ ? tr("Drawing the first picture …") : empty_text_);
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.setRenderHint(QPainter::Antialiasing);
  QRect target(QPoint(), picture_.size().scaled(size(), Qt::KeepAspectRatio));
  target.moveCenter(rect().center());
  painter.drawImage(target, picture_);
  PaintChosen(painter);
  PaintGaps(painter);
  PaintAxes(painter);
  if (const std::optional<PartGizmo> gizmo = GizmoIn(PictureView())) gizmo->Paint(painter, hot_);
  if (!advice_.isEmpty()) PaintLabel(painter, QPointF(14, 24), advice_, QColor(20, 60, 120));
  painter.setPen(ThemeColors().picture_text);
  painter.drawText(rect().adjusted(10, 0, -10, -8), Qt::AlignBottom | Qt::AlignLeft,
                   tr("click: choose   Ctrl+click: a second part   drag: orbit   right drag: pan   F: fit"));
}

// The box of each chosen part, along its own axes, and its name.
void PartsView::PaintChosen(QPainter& painter) const {
  for (const ShownPart& part : parts_) {
    if (part.choice == 0 || !part.is_visible || part.box_in_part.isEmpty()) continue;
    std::array<std::optional<QPointF>, 8> corners;
    for (int i = 0; i < 8; ++i)
      corners.at(static_cast<std::size_t>(i)) = PaintedAt(
          part.world_from_part * part.box_in_part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    const QColor ink = ChoiceColor(part.choice);
    painter.setPen(QPen(ink, 1.5));
    std::optional<QPointF> top;
    for (const auto& [i, j] : kBoxEdges) {
      const auto& a = corners.at(static_cast<std::size_t>(i));
      const auto& b = corners.at(static_cast<std::size_t>(j));
      if (a && b) painter.drawLine(*a, *b);
    }
    for (const auto& corner : corners)
      if (corner && (!top || corner->y() < top->y())) top = corner;
    if (top)
      PaintLabel(painter, *top + QPointF(6, -6), tr("%1: %2").arg(part.choice).arg(part.name),
                 ink.darker(150));
  }
}

void PartsView::PaintGaps(QPainter& painter) const {
  for (const ShownGap& gap : gaps_) {
    const auto a = PaintedAt(gap.from_in_world), b = PaintedAt(gap.to_in_world);
    if (!a || !b) continue;
    painter.setPen(QPen(kGapInk, 2.0));
    painter.drawLine(*a, *b);
    const QLineF line(*a, *b);
    if (line.length() > 0.0) {
      const QLineF across = line.normalVector().unitVector();
      const QPointF tick = kTickPx * (across.p2() - across.p1());
      for (const QPointF& end : {*a, *b}) painter.drawLine(end - tick, end + tick);
    }
    PaintLabel(painter, line.center() + QPointF(10, 4), gap.text, kGapInk);
  }
}

// The world's directions, in the lower right corner.
void PartsView::PaintAxes(QPainter& painter) const {
  constexpr double kLengthPx = 26.0;
  const QPointF origin(width() - 48.0, height() - 48.0);
  const recon::SceneView view = PictureView();
  const std::array inks = {QColor(196, 52, 44), QColor(46, 125, 50), QColor(33, 93, 176)};
  const std::array names = {QStringLiteral("x"), QStringLiteral("y"), QStringLiteral("z")};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis_in_cam = view.cam_from_world.rotation.col(i);
    const QPointF end = origin + kLengthPx * QPointF(axis_in_cam.x(), axis_in_cam.y());
    const auto at = static_cast<std::size_t>(i);
    painter.setPen(QPen(inks.at(at), 2.0));
    painter.drawLine(origin, end);
    painter.drawText(QRectF(origin + 1.35 * (end - origin) - QPointF(8, 8), QSizeF(16, 16)), Qt::AlignCenter,
                     names.at(at));
  }
}

}  // namespace elbowroom::console
