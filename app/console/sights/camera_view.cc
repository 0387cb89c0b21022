#include "app/console/sights/camera_view.h"

#include <QKeyEvent>
#include <QPainter>

#include "app/console/desktop/theme.h"
#include "app/console/view/picture_asker.h"
#include "recon/images/image.h"

namespace elbowroom::console {
namespace {

constexpr double kTroubledOpacity = 0.4;

}  // namespace

CameraView::CameraView(QWidget* parent) : QWidget(parent) {
  setObjectName("camera_view");
  setAccessibleName(tr("A camera's picture with the virtual parts"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(320, 110);  // as the 3-D view, in whose place it stands
}

void CameraView::Open(const QString& camera) {
  camera_ = camera;
  trouble_.clear();
  picture_ = QImage();
  setToolTip(tr("Camera %1, with the virtual parts; what is real before them hides them").arg(camera));
  update();
}

void CameraView::ShowTile(const control::CameraTile& tile) {
  const recon::Image& image = tile.enlarged;
  trouble_ = !tile.gone.empty() ? QString::fromStdString(tile.gone)
             : tile.is_missing  ? tr("no picture in this frame")
                                : QString();
  if (!image.rgb.empty()) picture_ = QtImageOf(image);
  update();
}

control::ThumbnailRoom CameraView::Room() const {
  const QSize room = size() * devicePixelRatio();
  return {room.width(), room.height()};
}

void CameraView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), ThemeColors().silhouette_background);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.setOpacity(trouble_.isEmpty() ? 1.0 : kTroubledOpacity);
  QRect target(QPoint(), picture_.isNull() ? QSize() : picture_.size().scaled(size(), Qt::KeepAspectRatio));
  target.moveCenter(rect().center());
  if (!picture_.isNull()) painter.drawImage(target, picture_);
  painter.setOpacity(1.0);
  painter.setPen(ThemeColors().silhouette_object);
  const QRect room = rect().adjusted(10, 6, -10, -8);
  const QString line = trouble_.isEmpty() ? camera_ : camera_ + ": ✖ " + trouble_;
  painter.drawText(room, Qt::AlignTop | Qt::AlignLeft, line);
  if (picture_.isNull())
    painter.drawText(room, Qt::AlignCenter, tr("Waiting for the camera's next picture …"));
  painter.drawText(room, Qt::AlignBottom | Qt::AlignLeft, tr("double click or Esc: back to the 3-D view"));
}

void CameraView::resizeEvent(QResizeEvent* /*event*/) { emit RoomChanged(); }

void CameraView::mouseDoubleClickEvent(QMouseEvent* /*event*/) { emit Closed(); }

void CameraView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) return emit Closed();
  QWidget::keyPressEvent(event);
}

}  // namespace elbowroom::console
