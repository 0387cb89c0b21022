#include "app/console/participant/participant_view.h"

#include <QKeyEvent>
#include <QPainter>
#include <QScreen>
#include <algorithm>
#include <utility>

#include "app/console/view/picture_asker.h"

namespace elbowroom::console {
namespace {

// Beyond this a picture costs software OpenGL more time than it gains in sharpness.
constexpr QSize kLargestPicture(960, 600);
constexpr QSize kFirstSize(960, 600);
constexpr int kSignMarginPx = 18;

}  // namespace

ParticipantView::ParticipantView(QWidget* parent) : QWidget(parent, Qt::Window) {
  setObjectName("participant_view");
  setAccessibleName(tr("Participant's view"));
  setWindowTitle(tr("Elbowroom – participant's view"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  setAttribute(Qt::WA_QuitOnClose, false);  // the program ends with the operator's window
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(320, 200);
  resize(kFirstSize);
}

void ParticipantView::ShowPicture(const control::ParticipantPicture& picture) {
  picture_ = QtImageOf(picture.image);
  const bool is_new = std::exchange(serial_, picture.serial) != picture.serial;
  measured_at_.reset();
  if (is_new && picture.pose.source != recon::HeadSource::kFixed) measured_at_ = picture.pose.measured_at;
  update();
}

void ParticipantView::Clear() {
  picture_ = QImage();
  measured_at_.reset();
  update();
}

void ParticipantView::ShowTracking(bool is_lost) {
  if (std::exchange(is_lost_, is_lost) != is_lost) update();
}

void ParticipantView::SetStereo(bool is_stereo) {
  if (std::exchange(is_stereo_, is_stereo) != is_stereo) update();
}

void ParticipantView::FillDisplay(const QScreen* screen) {
  if (screen != nullptr) setGeometry(screen->geometry());
  showFullScreen();
}

QSize ParticipantView::PictureSize() const {
  const QSize pixels = size() * devicePixelRatio();
  return pixels.boundedTo(pixels.scaled(kLargestPicture, Qt::KeepAspectRatio)).expandedTo(QSize(64, 64));
}

void ParticipantView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  if (picture_.isNull()) {
    painter.setPen(Qt::lightGray);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, tr("The trial has not begun yet."));
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  QRect target(QPoint(), picture_.size().scaled(size(), Qt::KeepAspectRatio));
  target.moveCenter(rect().center());
  painter.drawImage(target, picture_);
  if (is_lost_) {
    const int eyes = is_stereo_ ? 2 : 1;
    for (int eye = 0; eye < eyes; ++eye)
      PaintSign(painter, QRect(eye * width() / eyes, 0, width() / eyes, height()));
  }
  if (measured_at_) TellAge();
}

void ParticipantView::PaintSign(QPainter& painter, const QRect& room) const {
  const QString text = tr("Tracking lost – the view stays");
  QRect sign = painter.fontMetrics().boundingRect(text).adjusted(-10, -6, 10, 6);
  sign.moveCenter({room.center().x(), room.bottom() - kSignMarginPx - sign.height() / 2});
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor(0x20, 0x26, 0x2c, 0xd0));
  painter.drawRoundedRect(sign, 6, 6);
  painter.setPen(QColor(0xff, 0xc9, 0x66));
  painter.drawText(sign, Qt::AlignCenter, text);
}

// This event's painting has been handed to the screen when the next event comes.
void ParticipantView::TellAge() {
  QMetaObject::invokeMethod(
      this,
      [this, measured_at = *std::exchange(measured_at_, std::nullopt)] {
        const auto now = std::chrono::steady_clock::now();
        // A headset's pose is predicted: before its time it has no age.
        emit PictureSeen(std::max(0.0, std::chrono::duration<double, std::milli>(now - measured_at).count()));
      },
      Qt::QueuedConnection);
}

void ParticipantView::resizeEvent(QResizeEvent* /*event*/) { emit Resized(); }

void ParticipantView::closeEvent(QCloseEvent* event) {
  QWidget::closeEvent(event);
  emit Closed();
}

void ParticipantView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) {
    close();
  } else if (event->key() == Qt::Key_F11) {
    setWindowState(windowState() ^ Qt::WindowFullScreen);
  } else {
    QWidget::keyPressEvent(event);
  }
}

}  // namespace elbowroom::console
