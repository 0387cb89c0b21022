#include "app/console/operator_view.h"

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <utility>

#include "app/console/palette.h"
#include "app/control/scene_composer.h"

namespace elbowroom::console {
namespace {

// Beyond this a picture costs software OpenGL more time than it gains in sharpness.
constexpr QSize kLargestPicture(800, 600);
constexpr double kWheelStepEighths = 120.0;  // one notch of a wheel, in Qt's eighths of a degree

QImage ToQImage(const recon::Image& image) {
  const QImage view(image.rgb.data(), image.width_px, image.height_px, 3 * image.width_px,
                    QImage::Format_RGB888);
  return view.convertToFormat(QImage::Format_RGB32);  // a deep copy, in the format that paints fastest
}

}  // namespace

OperatorView::OperatorView(QWidget* parent)
    : QWidget(parent),
      worker_(
          [this](const recon::Image& image, const control::RenderRequest& request) {
            bridge_.PostLatest(Bridge::Stream::kPicture,
                               [this, picture = ToQImage(image), request] { ShowPicture(picture, request); });
          },
          [this](const std::string& line) {
            bridge_.PostLatest(Bridge::Stream::kPicture,
                               [this, text = QString::fromStdString(line)] { emit Failed(text); });
          }) {
  setMinimumSize(320, 240);
  setFocusPolicy(Qt::StrongFocus);
  setAttribute(Qt::WA_OpaquePaintEvent);
}

OperatorView::~OperatorView() = default;

void OperatorView::ShowFrame(control::SharedFrameResult result) {
  result_ = std::move(result);
  if (camera_) {
    AskForPicture();
  } else if (!fitting_) {
    Fit();
  }
}

void OperatorView::Clear() {
  camera_.reset();
  result_.reset();
  picture_ = QImage();
  update();
}

void OperatorView::Fit() {
  if (!result_ || fitting_) return;
  auto camera = std::make_shared<recon::OrbitCamera>();
  fitting_ = std::make_unique<BackgroundJob>(
      bridge_,
      [camera, result = result_, size = PictureSize()](const std::stop_token&) {
        *camera = control::OverviewCamera(*result, size.width(), size.height());
      },
      [this, camera](const std::string& error) {
        fitting_.reset();  // done; its thread has nothing left to do
        if (error.empty()) {
          Turn(*camera);
        } else {
          emit Failed(QString::fromStdString(error));
        }
      });
}

QString OperatorView::driver() const { return QString::fromStdString(worker_.driver()); }

void OperatorView::Turn(const recon::OrbitCamera& camera) {
  camera_ = camera;
  AskForPicture();
}

void OperatorView::AskForPicture() {
  if (!result_ || !camera_) return;
  const QSize size = PictureSize();
  worker_.Submit({result_, *camera_, size.width(), size.height()});
}

QSize OperatorView::PictureSize() const {
  const QSize pixels = size() * devicePixelRatio();
  return pixels.boundedTo(pixels.scaled(kLargestPicture, Qt::KeepAspectRatio)).expandedTo(QSize(16, 16));
}

void OperatorView::ShowPicture(const QImage& picture, const control::RenderRequest& request) {
  if (!result_) return;  // cleared since it was asked for
  picture_ = picture;
  update();
  emit PictureShown(request.result->frame);
}

void OperatorView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), kViewBackground);
  if (picture_.isNull()) {
    painter.setPen(kQuietText);
    painter.drawText(rect(), Qt::AlignCenter,
                     result_ ? tr("Drawing the first picture …")
                             : tr("No trial is running.\nStart the demo, or open a trial."));
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  QRect target(QPoint(), picture_.size().scaled(size(), Qt::KeepAspectRatio));
  target.moveCenter(rect().center());
  painter.drawImage(target, picture_);
  painter.setPen(kQuietText);
  painter.drawText(rect().adjusted(10, 0, -10, -8), Qt::AlignBottom | Qt::AlignLeft,
                   tr("drag: orbit   right drag: pan   wheel: zoom   F: fit"));
}

void OperatorView::resizeEvent(QResizeEvent* /*event*/) { AskForPicture(); }

void OperatorView::mousePressEvent(QMouseEvent* event) { last_mouse_px_ = event->position(); }

void OperatorView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = event->position() - std::exchange(last_mouse_px_, event->position());
  const Eigen::Vector2d drag_px(moved.x(), moved.y());
  if (!camera_) return;
  if (event->buttons() & Qt::LeftButton) {
    Turn(recon::Orbited(*camera_, drag_px, height()));
  } else if (event->buttons() & (Qt::RightButton | Qt::MiddleButton)) {
    Turn(recon::Panned(*camera_, drag_px, height()));
  }
}

void OperatorView::mouseDoubleClickEvent(QMouseEvent* event) {
  last_mouse_px_ = event->position();
  Fit();
}

void OperatorView::wheelEvent(QWheelEvent* event) {
  if (camera_) Turn(recon::Zoomed(*camera_, event->angleDelta().y() / kWheelStepEighths));
  event->accept();
}

}  // namespace elbowroom::console
