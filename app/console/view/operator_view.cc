#include "app/console/view/operator_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <chrono>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/view/dimension_painter.h"

namespace elbowroom::console {
namespace {

constexpr double kWheelStepEighths = 120.0;  // one notch of a wheel, in Qt's eighths of a degree

}  // namespace

OperatorView::OperatorView(QWidget* parent)
    : QWidget(parent),
      asker_(*this, {.request = [this](const QSize& size,
                                       const PictureFineness& fineness) { return Request(size, fineness); },
                     .take = [this](const QImage& picture,
                                    const control::RenderRequest& request) { return Take(picture, request); },
                     .shown = [this](double drawing_ms) { emit PictureShown(picture_frame_, drawing_ms); },
                     .failed = [this](const QString& line) { emit Failed(line); }}) {
  setMinimumSize(320, 110);  // with section planes above and a slider below it, on a screen of 540 px
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(tr("3-D view"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  setMouseTracking(true);
}

OperatorView::~OperatorView() = default;

void OperatorView::Foresee(const control::SharedHull& hull) {
  if (result_ && camera_ && !asker_.is_drawing()) asker_.worker().Foresee(hull);
}

void OperatorView::ShowFrame(control::SharedFrameResult result) {
  if (!result_) asker_.BeginPace();
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
  asker_.Forget();
  picture_ = QImage();
  update();
}

void OperatorView::Fit() {
  if (!result_ || fitting_) return;
  auto camera = std::make_shared<recon::OrbitCamera>();
  fitting_ = std::make_unique<BackgroundJob>(
      bridge_,
      [camera, result = result_, size = asker_.LargestPicture()](const std::stop_token&) {
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
  look_.hull = look.hull;
  TakeLook();
}

void OperatorView::SetHeat(control::SharedHeatLayer heat, const QString& of) {
  if (look_.heat == heat && heat_of_ == of) return;
  look_.heat = std::move(heat);
  heat_of_ = of;
  TakeLook();
}

void OperatorView::SetKnowledge(control::SharedRigKnowledge knowledge) {
  look_.knowledge = std::move(knowledge);
  TakeLook();
}

void OperatorView::TakeLook() {
  legends_ = LegendsOf(look_, heat_of_);
  setAccessibleDescription(TextOf(legends_));
  AskForPicture();
  update();
}

void OperatorView::SetCut(const control::SectionCut& cut) {
  look_.cut = cut;
  AskForPicture();
  update();  // the handles
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

QString OperatorView::driver() const { return QString::fromStdString(asker_.worker().driver()); }

void OperatorView::Turn(const recon::OrbitCamera& camera) {
  camera_ = camera;
  camera_->is_parallel = is_parallel_;
  looks_from_.reset();
  AskForPicture();
}

void OperatorView::AskForPicture() {
  if (CanDraw()) asker_.Ask();
}

bool OperatorView::CanDraw() const { return result_ && camera_ && isVisible(); }

std::optional<control::RenderRequest> OperatorView::Request(const QSize& size,
                                                            const PictureFineness& fineness) const {
  if (!CanDraw()) return std::nullopt;
  control::RenderRequest request{result_,       *camera_,           size.width(), size.height(),
                                 fineness.hull, fineness.is_smooth, look_};
  if (looks_from_)
    request.fixed_view = recon::ViewFrom(*looks_from_, camera_->target_in_world, size.width(), size.height());
  return request;
}

bool OperatorView::Take(const QImage& picture, const control::RenderRequest& request) {
  if (!result_ || request.result->layout != result_->layout) return false;  // of a trial that is over
  picture_ = picture;
  picture_request_ = request;
  picture_request_.result.reset();
  const qint64 last_frame = std::exchange(picture_frame_, request.result->record.frame);
  const auto& camera_frames = request.result->camera_frames;
  if (camera_frames && picture_frame_ != last_frame) taken_at_ = camera_frames->taken_at;
  update();
  return true;
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
  if (handles_.paint) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(target.topLeft());
    handles_.paint(painter, ShownView());
    painter.restore();
  }
  PaintDimensions(painter, ShownView(), target.topLeft(), dimensions_);
  PaintLegends(painter, rect(), legends_);
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

std::optional<recon::SceneView> OperatorView::shown_view() const {
  return picture_.isNull() ? std::nullopt : std::optional(ShownView());
}

Eigen::Vector2d OperatorView::PixelAt(const QPointF& position) const {
  const QPointF at = position - QPointF(PictureRect().topLeft()) - QPointF(0.5, 0.5);
  return {at.x(), at.y()};
}

void OperatorView::mousePressEvent(QMouseEvent* event) {
  last_mouse_px_ = pressed_px_ = event->position();
  if (event->button() != Qt::LeftButton || picture_.isNull() || !handles_.press) return;
  is_handle_held_ = handles_.press(ShownView(), PixelAt(event->position()));
}

void OperatorView::mouseReleaseEvent(QMouseEvent* event) {
  constexpr double kStillPx = 3.0;
  if (event->button() == Qt::LeftButton && std::exchange(is_handle_held_, false))
    return handles_.release(true);
  if (std::exchange(is_shift_dragging_, false)) emit ShiftDragEnded();
  const QPointF moved = event->position() - pressed_px_;
  if (event->button() != Qt::LeftButton || picture_.isNull() || moved.manhattanLength() > kStillPx) return;
  emit Clicked(ShownView(), PixelAt(event->position()));
}

void OperatorView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = event->position() - std::exchange(last_mouse_px_, event->position());
  const Eigen::Vector2d drag_px(moved.x(), moved.y());
  if (!camera_) return;
  if (is_handle_held_)
    return handles_.drag(ShownView(), PixelAt(event->position()),
                         event->modifiers().testFlag(Qt::ShiftModifier));
  if (event->buttons() == Qt::NoButton) {
    if (handles_.hover && !picture_.isNull()) handles_.hover(ShownView(), PixelAt(event->position()));
  } else if ((event->buttons() & Qt::LeftButton) && (event->modifiers() & Qt::ShiftModifier)) {
    // Panning moves the target against the pointer.
    const recon::OrbitCamera panned = recon::Panned(*camera_, drag_px, height());
    is_shift_dragging_ = true;
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

void OperatorView::keyPressEvent(QKeyEvent* event) {
  if (event->key() != Qt::Key_Escape || !std::exchange(is_handle_held_, false))
    return QWidget::keyPressEvent(event);
  handles_.release(false);
}

void OperatorView::wheelEvent(QWheelEvent* event) {
  if (camera_) Turn(recon::Zoomed(*camera_, event->angleDelta().y() / kWheelStepEighths));
  event->accept();
}

}  // namespace elbowroom::console
