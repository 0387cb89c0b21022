#include "app/console/view/operator_view.h"

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <chrono>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/view/dimension_painter.h"

namespace elbowroom::console {
namespace {

// Beyond these a picture costs more time than it gains in sharpness.
constexpr QSize kLargestBySoftware(1280, 800);
constexpr QSize kLargestByCard(3840, 2400);
// A scene that hasn't changed for this long is drawn in full.
constexpr std::chrono::milliseconds kRests(400);
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
            bridge_.PostLatest(Bridge::Stream::kPicture, [this, text = QString::fromStdString(line)] {
              drawing_.invalidate();
              if (text != std::exchange(last_error_, text)) emit Failed(text);
            });
          }) {
  setMinimumSize(320, 240);
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(tr("3-D view"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  rest_.setSingleShot(true);
  rest_.setInterval(kRests);
  connect(&rest_, &QTimer::timeout, this, [this] {
    if (result_ && camera_ && !drawing_.isValid()) Submit(PicturePace::kFinest);
  });
}

OperatorView::~OperatorView() = default;

void OperatorView::Foresee(const control::SharedHull& hull) {
  if (result_ && camera_ && !drawing_.isValid()) worker_.Foresee(hull);
}

void OperatorView::ShowFrame(control::SharedFrameResult result) {
  if (!result_) pace_ = PicturePace();
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
  is_outdated_ = false;
  picture_ = QImage();
  update();
}

void OperatorView::Fit() {
  if (!result_ || fitting_) return;
  auto camera = std::make_shared<recon::OrbitCamera>();
  fitting_ = std::make_unique<BackgroundJob>(
      bridge_,
      [camera, result = result_, size = LargestPicture()](const std::stop_token&) {
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

void OperatorView::SetLook(const control::SceneLook& look) {
  const control::SectionCut cut = look_.cut;
  look_ = look;
  look_.cut = cut;
  AskForPicture();
}

void OperatorView::SetCut(const control::SectionCut& cut) {
  look_.cut = cut;
  AskForPicture();
}

void OperatorView::SetDimensions(std::vector<control::Dimension> dimensions) {
  dimensions_ = std::move(dimensions);
  update();
}

void OperatorView::LookAlong(recon::StandardView view) {
  if (camera_) Turn(recon::Along(*camera_, view));
}

void OperatorView::SetParallel(bool is_parallel) {
  is_parallel_ = is_parallel;
  if (camera_) Turn(*camera_);
}

void OperatorView::LookFrom(const core::CameraModel& camera) {
  if (!camera_) return;
  camera_ = recon::OrbitLike(camera, camera_->target_in_world);
  looks_from_ = camera;
  AskForPicture();
}

QString OperatorView::driver() const { return QString::fromStdString(worker_.driver()); }

void OperatorView::Turn(const recon::OrbitCamera& camera) {
  camera_ = camera;
  camera_->is_parallel = is_parallel_;
  looks_from_.reset();
  AskForPicture();
}

void OperatorView::AskForPicture() {
  if (!result_ || !camera_ || !isVisible()) return;
  if (drawing_.isValid()) {
    is_outdated_ = true;
  } else {
    Submit(pace_.fineness());
  }
}

void OperatorView::Submit(const PictureFineness& fineness) {
  const QSize size = LargestPicture() * fineness.picture;
  drawn_with_ = fineness;
  is_outdated_ = false;
  drawing_.start();
  control::RenderRequest request{result_,       *camera_,           size.width(), size.height(),
                                 fineness.hull, fineness.is_smooth, look_};
  if (looks_from_)
    request.fixed_view = recon::ViewFrom(*looks_from_, camera_->target_in_world, size.width(), size.height());
  worker_.Submit(std::move(request));
}

QSize OperatorView::LargestPicture() const {
  const QSize pixels = size() * devicePixelRatio();
  const QSize largest = worker_.is_software().value_or(true) ? kLargestBySoftware : kLargestByCard;
  return pixels.boundedTo(pixels.scaled(largest, Qt::KeepAspectRatio)).expandedTo(QSize(64, 64));
}

void OperatorView::ShowPicture(const QImage& picture, const control::RenderRequest& request) {
  const double drawing_ms = 1e-6 * static_cast<double>(drawing_.nsecsElapsed());
  drawing_.invalidate();
  if (!result_ || request.result->layout != result_->layout)
    return AskForPicture();  // of a trial that is over
  last_error_.clear();
  if (drawn_with_ == pace_.fineness()) pace_.Add(drawing_ms);
  picture_ = picture;
  picture_request_ = request;
  picture_request_.result.reset();
  const qint64 last_frame = std::exchange(picture_frame_, request.result->record.frame);
  const auto& camera_frames = request.result->camera_frames;
  if (camera_frames && picture_frame_ != last_frame) taken_at_ = camera_frames->taken_at;
  update();
  if (is_outdated_) {
    Submit(pace_.fineness());
  } else if (drawn_with_ != PicturePace::kFinest) {
    rest_.start();
  }
  emit PictureShown(picture_frame_, drawing_ms);
}

void OperatorView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), ThemeColors().view_background);
  if (picture_.isNull()) {
    painter.setPen(ThemeColors().quiet_text);
    painter.drawText(rect(), Qt::AlignCenter,
                     result_ ? tr("Drawing the first picture …")
                             : tr("No trial is running.\nStart the demo, or open a trial."));
    return;
  }
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  const QRect target = PictureRect();
  painter.drawImage(target, picture_);
  PaintDimensions(painter, ShownView(), target.topLeft(), dimensions_);
  PaintCaption(painter);
  if (taken_at_) TellAge();
}

QRect OperatorView::PictureRect() const {
  QRect target(QPoint(), picture_.size().scaled(size(), Qt::KeepAspectRatio));
  target.moveCenter(rect().center());
  return target;
}

recon::SceneView OperatorView::ShownView() const {
  const QSize px = PictureRect().size();
  if (!picture_request_.fixed_view) return recon::ViewFrom(picture_request_.camera, px.width(), px.height());
  recon::SceneView view = *picture_request_.fixed_view;
  view.focal_px *= static_cast<double>(px.height()) / view.height_px;
  view.width_px = px.width();
  view.height_px = px.height();
  return view;
}

// This event's painting has been handed to the screen when the next event comes.
void OperatorView::TellAge() {
  QMetaObject::invokeMethod(
      this,
      [this, frame = picture_frame_, taken_at = *std::exchange(taken_at_, std::nullopt)] {
        emit PictureSeen(
            frame,
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - taken_at).count());
      },
      Qt::QueuedConnection);
}

void OperatorView::PaintCaption(QPainter& painter) const {
  const QRect room = rect().adjusted(10, 0, -10, -8);
  painter.setPen(ThemeColors().picture_text);
  painter.drawText(room, Qt::AlignBottom | Qt::AlignLeft,
                   tr("drag: orbit   right drag: pan   wheel: zoom   F: fit"));
  painter.drawText(room, Qt::AlignBottom | Qt::AlignRight, tr("frame %1").arg(picture_frame_));
}

void OperatorView::showEvent(QShowEvent* /*event*/) { AskForPicture(); }

void OperatorView::resizeEvent(QResizeEvent* /*event*/) { AskForPicture(); }

void OperatorView::mousePressEvent(QMouseEvent* event) { last_mouse_px_ = pressed_px_ = event->position(); }

void OperatorView::mouseReleaseEvent(QMouseEvent* event) {
  constexpr double kStillPx = 3.0;
  const QPointF moved = event->position() - pressed_px_;
  if (event->button() != Qt::LeftButton || picture_.isNull() || moved.manhattanLength() > kStillPx) return;
  const QPointF at = event->position() - QPointF(PictureRect().topLeft()) - QPointF(0.5, 0.5);
  emit Clicked(ShownView(), {at.x(), at.y()});
}

void OperatorView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = event->position() - std::exchange(last_mouse_px_, event->position());
  const Eigen::Vector2d drag_px(moved.x(), moved.y());
  if (!camera_) return;
  if ((event->buttons() & Qt::LeftButton) && (event->modifiers() & Qt::ShiftModifier)) {
    // Panning moves the target against the pointer.
    const recon::OrbitCamera panned = recon::Panned(*camera_, drag_px, height());
    emit ShiftDragged(camera_->target_in_world - panned.target_in_world);
  } else if (event->buttons() & Qt::LeftButton) {
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
