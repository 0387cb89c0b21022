// What mouse and keys do in the view of the parts.
#include <QApplication>
#include <QMouseEvent>
#include <QWheelEvent>
#include <utility>

#include "app/console/layouts/parts_view.h"

namespace elbowroom::console {
namespace {

constexpr double kNotchEighths = 120.0;  // of a wheel, in Qt's eighths of a degree

}  // namespace

control::PickRay PartsView::RayAt(const QPointF& position) const {
  return control::RayThrough(WidgetView(), {position.x() - 0.5, position.y() - 0.5});
}

std::optional<std::size_t> PartsView::FirstChosen() const {
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (parts_[i].choice == 1 && parts_[i].is_visible && !parts_[i].box_in_part.isEmpty()) return i;
  return std::nullopt;
}

Eigen::Vector3d PartsView::CenterOf(std::size_t part) const {
  return parts_[part].world_from_part * parts_[part].box_in_part.center();
}

std::optional<PartGizmo> PartsView::Gizmo() const { return camera_ ? GizmoIn(WidgetView()) : std::nullopt; }

std::optional<PartGizmo> PartsView::GizmoIn(const recon::SceneView& view) const {
  const std::optional<std::size_t> chosen = FirstChosen();
  if (!chosen || !advice_.isEmpty()) return std::nullopt;
  return PartGizmo(view, CenterOf(*chosen), parts_[*chosen].may_move);
}

void PartsView::mousePressEvent(QMouseEvent* event) {
  last_mouse_px_ = pressed_px_ = event->position();
  const std::optional<PartGizmo> gizmo = Gizmo();
  if (event->button() != Qt::LeftButton || !gizmo) return;
  hot_ = gizmo->HandleAt(event->position());
  if (!hot_) return;
  const std::size_t part = *FirstChosen();
  drag_ = GizmoDrag::Begin(*hot_, CenterOf(part), parts_[part].world_from_part, RayAt(event->position()));
}

void PartsView::DragTo(const QPointF& position, bool in_steps) {
  parts_[*FirstChosen()].world_from_part = drag_->At(RayAt(position), in_steps);
  MakeScene();
  AskForPicture();
  update();
}

void PartsView::EndDrag(bool is_kept) {
  const std::size_t part = *FirstChosen();
  const core::RigidTransform start = drag_->start();
  drag_.reset();
  if (!is_kept) {
    parts_[part].world_from_part = start;
    MakeScene();
    AskForPicture();
    return update();
  }
  const core::RigidTransform placed = parts_[part].world_from_part;
  if (!(placed == start)) emit Dragged(static_cast<int>(part), placed);
}

void PartsView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = event->position() - std::exchange(last_mouse_px_, event->position());
  if (!camera_) return;
  if (drag_) return DragTo(event->position(), event->modifiers().testFlag(Qt::ShiftModifier));
  const Eigen::Vector2d drag_px(moved.x(), moved.y());
  if (event->buttons() & Qt::LeftButton) {
    Turn(recon::Orbited(*camera_, drag_px, height()));
  } else if (event->buttons() & (Qt::RightButton | Qt::MiddleButton)) {
    Turn(recon::Panned(*camera_, drag_px, height()));
  } else if (const std::optional<PartGizmo> gizmo = Gizmo()) {
    if (hot_ != std::exchange(hot_, gizmo->HandleAt(event->position()))) update();
  }
}

void PartsView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (drag_) return EndDrag(true);
  if ((event->position() - pressed_px_).manhattanLength() >= QApplication::startDragDistance()) return;
  const auto pick = PickAt(event->position());
  if (!advice_.isEmpty()) {
    if (pick) emit PointPicked(*pick);
    return;
  }
  emit Picked(pick ? static_cast<int>(pick->part) : -1, event->modifiers().testFlag(Qt::ControlModifier));
}

void PartsView::mouseDoubleClickEvent(QMouseEvent* event) {
  last_mouse_px_ = pressed_px_ = event->position();
  if (advice_.isEmpty()) Fit();
}

void PartsView::wheelEvent(QWheelEvent* event) {
  if (camera_) Turn(recon::Zoomed(*camera_, event->angleDelta().y() / kNotchEighths));
  event->accept();
}

// F is the window's shortcut for the trial's picture, too.
bool PartsView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && static_cast<QKeyEvent*>(event)->key() == Qt::Key_F)
    event->accept();
  return QWidget::event(event);
}

void PartsView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_F && event->modifiers() == Qt::NoModifier) {
    Fit();
  } else if (event->key() == Qt::Key_Escape && drag_) {
    EndDrag(false);
  } else {
    QWidget::keyPressEvent(event);
  }
}

}  // namespace elbowroom::console
