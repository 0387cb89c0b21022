// The layout's parts in 3-D: turned by the mouse, chosen by clicks.
#pragma once

#include <QImage>
#include <QPainter>
#include <QPoint>
#include <QString>
#include <QWidget>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/console/layouts/part_gizmo.h"
#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/console/view/picture_asker.h"
#include "app/control/picking/pick.h"
#include "recon/appearance/orbit_camera.h"

namespace elbowroom::console {

struct ShownPart {
  QString name;
  core::SharedMesh mesh;
  core::RigidTransform world_from_part;
  Eigen::Vector3f color = Eigen::Vector3f::Zero();  // as recon::gl::ScenePart
  float opacity = 1.0F;
  bool is_visible = true;
  int choice = 0;                                     // 0: not chosen; 1: the first that is; 2: the second
  std::array<bool, 3> may_move = {true, true, true};  // along the world's axes; a gap decides the others
  // The view's own: of the mesh, and where the part stands. Empty: a worker is finding them.
  Eigen::AlignedBox3d box_in_part = Eigen::AlignedBox3d();
  Eigen::AlignedBox3d box_in_world = Eigen::AlignedBox3d();
};

// Drawn over the picture: a gap from end to end, with its words beside it.
struct ShownGap {
  Eigen::Vector3d from_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_in_world = Eigen::Vector3d::Zero();
  QString text;
};

// Left drag orbits, right or middle drag pans, the wheel zooms, a double click fits; a click chooses a part,
// with Ctrl beside the one that is chosen. The first chosen part has handles: dragging one moves or turns it,
// with Shift in whole millimetres and steps of 5 degrees; Esc ends a drag where it began. Never waits for a
// picture, as OperatorView. Parts can be picked as soon as a worker has made the trees of their meshes; a
// worker finds the boxes of large meshes, too, which are shown then. Thread: UI.
class PartsView : public QWidget {
  Q_OBJECT

 public:
  explicit PartsView(QWidget* parent = nullptr);
  ~PartsView() override;

  // The first parts since there were none are fitted to the view.
  void Show(std::vector<ShownPart> parts, std::vector<ShownGap> gaps);
  // A line at the top: what a click does now, other than choosing; clicks are told by PointPicked alone. "":
  // they choose.
  void SetAdvice(const QString& advice);
  void SetEmptyText(const QString& text);  // stands there while there are no parts
  void Fit();
  // Along that direction of the world, fitted.
  void LookAlong(double azimuth_rad, double elevation_rad);

  // What is under that place of the widget; nothing where no part is, or its tree isn't made yet.
  [[nodiscard]] std::optional<control::Pick> PickAt(const QPointF& position) const;
  // Where a point of the world is in the widget; nothing where it is behind the eye.
  [[nodiscard]] std::optional<QPointF> PositionOf(const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] bool CanPick() const;  // every part that is visible
  [[nodiscard]] bool is_measuring() const { return measuring_ != nullptr; }
  // The handles at the first chosen part; nothing where none is chosen or visible.
  [[nodiscard]] std::optional<PartGizmo> Gizmo() const;
  [[nodiscard]] const QImage& picture() const { return picture_; }

 signals:
  // `part`: its index in Show()'s parts; -1: none is there. `adds`: Ctrl was held.
  void Picked(int part, bool adds);
  void PointPicked(const control::Pick& pick);
  void Dragged(int part, const core::RigidTransform& world_from_part);  // and released there
  void PictureShown();
  void Failed(const QString& line);

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  using SharedTree = std::shared_ptr<const core::TriangleTree>;

  void Turn(const recon::OrbitCamera& camera);
  void Measure();  // the boxes that aren't known yet, of large meshes on a worker
  void ShowMeasured();
  void MakeScene();
  void MakeTrees();
  void AskForPicture();
  [[nodiscard]] std::optional<control::RenderRequest> Request(const QSize& size,
                                                              const PictureFineness& fineness) const;
  bool Take(const QImage& picture, const control::RenderRequest& request);
  [[nodiscard]] recon::SceneView WidgetView() const;
  // What is painted over the picture belongs where the picture has it, also while a newer one is drawn.
  [[nodiscard]] recon::SceneView PictureView() const;
  [[nodiscard]] std::optional<QPointF> PaintedAt(const Eigen::Vector3d& x_in_world) const;
  [[nodiscard]] std::optional<PartGizmo> GizmoIn(const recon::SceneView& view) const;
  [[nodiscard]] control::PickRay RayAt(const QPointF& position) const;
  [[nodiscard]] std::optional<std::size_t> FirstChosen() const;
  [[nodiscard]] Eigen::Vector3d CenterOf(std::size_t part) const;  // in world
  void DragTo(const QPointF& position, bool in_steps);
  void EndDrag(bool is_kept);
  void PaintChosen(QPainter& painter) const;
  void PaintGaps(QPainter& painter) const;
  void PaintAxes(QPainter& painter) const;

  std::vector<ShownPart> parts_;
  std::vector<ShownGap> gaps_;
  QString empty_text_;
  QString advice_;
  std::optional<GizmoHandle> hot_;  // under the pointer, or dragged
  std::optional<GizmoDrag> drag_;
  Eigen::AlignedBox3d bounds_in_world_;
  std::map<core::SharedMesh, SharedTree> trees_;
  std::shared_ptr<const recon::gl::Scene> scene_;  // null: there are no parts
  std::optional<recon::OrbitCamera> camera_;
  std::optional<recon::OrbitCamera> picture_camera_;
  QImage picture_;
  QPointF last_mouse_px_;
  QPointF pressed_px_;
  Bridge bridge_;  // before the thread that posts to it
  bool fits_when_measured_ = false;
  std::unique_ptr<BackgroundJob> measuring_, tree_making_;
  PictureAsker asker_;
};

}  // namespace elbowroom::console
