#include "app/console/camera_strip.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QPainter>
#include <algorithm>
#include <array>

#include "app/console/desktop/theme.h"
#include "app/console/view/picture_asker.h"
#include "recon/images/image.h"

namespace elbowroom::console {
namespace {

constexpr int kStripHeightPx = 196, kLeastStripHeightPx = 110;
constexpr int kLeastCaptionWidthPx = 150;  // a caption may be wider than a narrow picture
constexpr int kCaptionLines = 3;
constexpr double kGoneOpacity = 0.25;

QImage TilePicture(const recon::Image& image, bool is_gone) {
  const QImage picture = QtImageOf(image);
  return is_gone ? picture.convertToFormat(QImage::Format_Grayscale8) : picture;
}

// Left and right on one line; the left text is shortened where there isn't room for both.
void PaintPair(QPainter& painter, const QRect& line, const QString& left, const QString& right,
               const QColor& left_color, const QColor& right_color) {
  painter.setPen(right_color);
  painter.drawText(line, Qt::AlignRight | Qt::AlignVCenter, right);
  painter.setPen(left_color);
  const int room_px =
      line.width() - (right.isEmpty() ? 0 : painter.fontMetrics().horizontalAdvance(right) + 8);
  painter.drawText(line, Qt::AlignLeft | Qt::AlignVCenter,
                   painter.fontMetrics().elidedText(left, Qt::ElideRight, room_px));
}

}  // namespace

CameraThumbnail::CameraThumbnail(const core::CameraModel& camera, QWidget* parent)
    : QWidget(parent),
      name_(QString::fromStdString(camera.name())),
      camera_px_(camera.width_px(), camera.height_px()) {
  setMinimumWidth(60);
  setFocusPolicy(Qt::StrongFocus);
  setObjectName("camera_tile:" + name_);
  setAccessibleName(tr("Camera %1").arg(name_));
  setToolTip(tr("Double click: this camera's picture, large"));
}

void CameraThumbnail::ShowTile(const control::CameraTile& tile) {
  picture_ = TilePicture(tile.picture, !tile.gone.empty());
  text_ = TextOf(tile);
  setToolTip(text_.tool_tip + (text_.tool_tip.isEmpty() ? "" : "\n") +
             tr("Double click: this camera's picture, large"));
  update();
}

int CameraThumbnail::CaptionHeight() const { return kCaptionLines * fontMetrics().height() + 4; }

QSize CameraThumbnail::PictureRoom() const {
  return QSize(width(), std::max(0, height() - CaptionHeight())) * devicePixelRatio();
}

void CameraThumbnail::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const QRect room(0, 0, width(), std::max(0, height() - CaptionHeight()));
  QRect picture(QPoint(), camera_px_.scaled(room.size(), Qt::KeepAspectRatio));
  picture.moveCenter(room.center());
  PaintPicture(painter, picture);
  const int caption_width_px = std::min(width(), std::max(picture.width(), kLeastCaptionWidthPx));
  PaintCaption(painter, QRect((width() - caption_width_px) / 2, picture.bottom() + 2, caption_width_px,
                              CaptionHeight()));
}

void CameraThumbnail::mouseDoubleClickEvent(QMouseEvent* /*event*/) { emit Chosen(); }

void CameraThumbnail::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) return emit Chosen();
  QWidget::keyPressEvent(event);
}

void CameraThumbnail::PaintPicture(QPainter& painter, const QRect& room) const {
  painter.fillRect(room, ThemeColors().silhouette_background);
  const bool is_troubled = !text_.trouble.isEmpty();
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.setOpacity(is_troubled ? kGoneOpacity : 1.0);
  if (!picture_.isNull()) painter.drawImage(room, picture_);
  painter.setOpacity(1.0);
  if (!is_troubled) return;
  painter.setPen(ThemeColors().silhouette_object);
  painter.drawText(room.adjusted(6, 4, -6, -4), Qt::AlignCenter | Qt::TextWordWrap, "✖ " + text_.trouble);
}

void CameraThumbnail::PaintCaption(QPainter& painter, const QRect& room) const {
  const QColor normal = palette().color(QPalette::WindowText);
  const std::array<std::array<QString, 2>, kCaptionLines> lines = {
      {{name_, text_.rate}, {text_.lost, text_.skew}, {text_.light, text_.advice}}};
  QRect line(room.topLeft(), QSize(room.width(), fontMetrics().height()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const QColor right = i == 2 ? ThemeColors().attention : ThemeColors().quiet_text;
    PaintPair(painter, line, lines[i][0], lines[i][1], i == 0 ? normal : ThemeColors().quiet_text, right);
    line.translate(0, line.height());
  }
}

CameraStrip::CameraStrip(QWidget* parent) : QFrame(parent) {
  setMinimumHeight(kLeastStripHeightPx);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(6, 4, 6, 0);
  row->setSpacing(10);
  hide();
}

QSize CameraStrip::sizeHint() const { return {QFrame::sizeHint().width(), kStripHeightPx}; }

void CameraStrip::Open(const core::Rig& rig) {
  qDeleteAll(thumbnails_);
  thumbnails_.clear();
  for (const core::CameraModel& camera : rig.cameras) {
    thumbnails_.push_back(new CameraThumbnail(camera, this));
    layout()->addWidget(thumbnails_.back());
    connect(thumbnails_.back(), &CameraThumbnail::Chosen, this,
            [this, i = static_cast<int>(thumbnails_.size()) - 1] { emit CameraChosen(i); });
  }
  show();
}

void CameraStrip::ShowTiles(const control::SharedTiles& tiles) {
  for (std::size_t i = 0; i < std::min(tiles->size(), thumbnails_.size()); ++i)
    thumbnails_[i]->ShowTile((*tiles)[i]);
}

void CameraStrip::SetWindowMinimized(bool is_minimized) {
  is_minimized_ = is_minimized;
  TellRoom();
}

// The layout has given the thumbnails their sizes when it asks for a new one, or is shown.
bool CameraStrip::event(QEvent* event) {
  const bool is_done = QFrame::event(event);
  switch (event->type()) {
    case QEvent::Show:
    case QEvent::Hide:
    case QEvent::Resize:
    case QEvent::LayoutRequest:
      TellRoom();
      break;
    default:
      break;
  }
  return is_done;
}

void CameraStrip::TellRoom() {
  control::ThumbnailRoom room;
  if (isVisible() && !is_minimized_ && !thumbnails_.empty()) {
    layout()->activate();
    QSize px = thumbnails_.front()->PictureRoom();  // they differ by the pixel that the layout has over
    for (const CameraThumbnail* thumbnail : thumbnails_) px = px.boundedTo(thumbnail->PictureRoom());
    room = {px.width(), px.height()};
  }
  if (room == std::exchange(told_, room)) return;
  emit RoomChanged(room);
}

}  // namespace elbowroom::console
