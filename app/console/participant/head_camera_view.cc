#include "app/console/participant/head_camera_view.h"

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <utility>

namespace elbowroom::console {
namespace {

constexpr double kMarkRadius = 6.0;
constexpr int kWheelStep = 120;

}  // namespace

HeadCameraView::HeadCameraView(QWidget* parent) : QWidget(parent) {
  setObjectName("head_camera_view");
  setAccessibleName(tr("Picture of the head camera with the parts"));
  setToolTip(tr("Drag to turn the camera; the wheel changes the focal length; while marking, click"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(400, 300);
}

void HeadCameraView::ShowPicture(const QImage& picture) {
  picture_ = picture;
  update();
}

void HeadCameraView::ShowMarks(std::vector<Mark> marks) {
  marks_ = std::move(marks);
  update();
}

void HeadCameraView::SetMarking(bool is_marking) {
  is_marking_ = is_marking;
  setCursor(is_marking ? Qt::CrossCursor : Qt::SizeAllCursor);
}

QRectF HeadCameraView::PictureRect() const {
  QRectF rect(QPointF(), QSizeF(picture_.size()).scaled(size(), Qt::KeepAspectRatio));
  rect.moveCenter(QRectF(this->rect()).center());
  return rect;
}

double HeadCameraView::Scale() const { return PictureRect().width() / std::max(1, picture_.width()); }

// Pixel centres are at integers.
QPointF HeadCameraView::PixelAt(const QPointF& at) const {
  return (at - PictureRect().topLeft()) / Scale() - QPointF(0.5, 0.5);
}

QPoint HeadCameraView::WidgetPointOf(const QPointF& pixel) const {
  return (PictureRect().topLeft() + Scale() * (pixel + QPointF(0.5, 0.5))).toPoint();
}

void HeadCameraView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  if (picture_.isNull()) {
    painter.setPen(Qt::lightGray);
    painter.drawText(rect().adjusted(20, 20, -20, -20), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("Start a trial, or open a picture: then it is shown here with the parts."));
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.drawImage(PictureRect(), picture_);
  const auto at = [this](const QPointF& pixel) {
    return PictureRect().topLeft() + Scale() * (pixel + QPointF(0.5, 0.5));
  };
  for (const Mark& mark : marks_) {
    const QColor color = mark.is_chosen ? QColor(0xff, 0xff, 0xff) : QColor(0xff, 0xc9, 0x66);
    for (const auto& [width, pen] : {std::pair{4.0, QColor(0, 0, 0, 160)}, std::pair{1.6, color}}) {
      painter.setPen(QPen(pen, width));
      painter.drawEllipse(at(mark.corner), kMarkRadius, kMarkRadius);
      if (!mark.seen) continue;
      const QPointF cross = at(*mark.seen);
      painter.drawLine(at(mark.corner), cross);
      painter.drawLine(cross - QPointF(kMarkRadius, 0), cross + QPointF(kMarkRadius, 0));
      painter.drawLine(cross - QPointF(0, kMarkRadius), cross + QPointF(0, kMarkRadius));
    }
  }
}

void HeadCameraView::mousePressEvent(QMouseEvent* event) {
  setFocus();
  if (event->button() != Qt::LeftButton || picture_.isNull()) return;
  if (is_marking_) {
    emit Clicked(PixelAt(event->position()));
  } else {
    dragged_from_ = event->position();
  }
}

void HeadCameraView::mouseMoveEvent(QMouseEvent* event) {
  if (!dragged_from_) return;
  const QPointF by = (event->position() - *dragged_from_) / Scale();
  dragged_from_ = event->position();
  emit Dragged(by);
}

void HeadCameraView::mouseReleaseEvent(QMouseEvent* /*event*/) { dragged_from_.reset(); }

void HeadCameraView::wheelEvent(QWheelEvent* event) {
  const int steps = event->angleDelta().y() / kWheelStep;
  if (steps != 0) emit Wheeled(steps);
  event->accept();
}

}  // namespace elbowroom::console
