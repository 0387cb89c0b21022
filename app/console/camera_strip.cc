#include "app/console/camera_strip.h"

#include <QHBoxLayout>
#include <QLocale>
#include <QPainter>
#include <algorithm>

#include "app/console/palette.h"
#include "app/console/silhouette_picture.h"

namespace elbowroom::console {
namespace {

constexpr int kLargestPictureWidthPx = 360;
constexpr int kStripHeightPx = 148;
constexpr int kCaptionWidthPx = 140;

}  // namespace

CameraThumbnail::CameraThumbnail(const core::CameraModel& camera, QWidget* parent)
    : QWidget(parent),
      name_(QString::fromStdString(camera.name())),
      camera_px_(camera.width_px(), camera.height_px()) {
  setMinimumWidth(60);
}

void CameraThumbnail::ShowMask(const core::BitMask& mask) {
  picture_ = SilhouettePicture(mask, kLargestPictureWidthPx);
  object_px_ = mask.CountObjectPixels();
  update();
}

void CameraThumbnail::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  const int text_height_px = painter.fontMetrics().height() + 4;
  const QSize room(width(), height() - text_height_px);
  QRect target(QPoint(), camera_px_.scaled(room, Qt::KeepAspectRatio));
  target.moveCenter(QRect(QPoint(), room).center());
  painter.fillRect(target, kSilhouetteBackground);
  if (!picture_.isNull()) painter.drawImage(target, picture_);

  // The caption is under its picture, and wider than a picture that is too narrow for name and count.
  const int caption_width_px = std::min(width(), std::max(target.width(), kCaptionWidthPx));
  QRect caption(0, height() - text_height_px, caption_width_px, text_height_px);
  caption.moveLeft((width() - caption_width_px) / 2);
  const QString count = QLocale().toString(static_cast<qulonglong>(object_px_)) + " px";
  painter.setPen(kQuietText);
  painter.drawText(caption, Qt::AlignRight | Qt::AlignVCenter, count);
  painter.setPen(palette().color(QPalette::WindowText));
  const int name_width_px = caption.width() - painter.fontMetrics().horizontalAdvance(count) - 8;
  painter.drawText(caption, Qt::AlignLeft | Qt::AlignVCenter,
                   painter.fontMetrics().elidedText(name_, Qt::ElideRight, name_width_px));
}

CameraStrip::CameraStrip(QWidget* parent) : QFrame(parent) {
  setFixedHeight(kStripHeightPx);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 4, 0, 0);
  row->setSpacing(10);
}

void CameraStrip::Open(const core::Rig& rig) {
  qDeleteAll(thumbnails_);
  thumbnails_.clear();
  shown_.reset();
  for (const core::CameraModel& camera : rig.cameras) {
    thumbnails_.push_back(new CameraThumbnail(camera, this));
    layout()->addWidget(thumbnails_.back());
  }
}

void CameraStrip::ShowMasks(const core::SharedMasks& masks) {
  for (std::size_t i = 0; i < masks->size() && i < thumbnails_.size(); ++i) {
    const core::BitMask& mask = (*masks)[i].mask;
    if (!shown_ || (*shown_)[i].mask != mask) thumbnails_[i]->ShowMask(mask);
  }
  shown_ = masks;
}

}  // namespace elbowroom::console
