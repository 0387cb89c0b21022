// The operator's view of the trial: the render worker's last picture, turned by the mouse.
#pragma once

#include <QImage>
#include <QPainter>
#include <QPoint>
#include <QString>
#include <QWidget>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/console/view/picture_asker.h"
#include "app/console/view/scale_legend.h"
#include "app/control/frame_result.h"
#include "app/control/measuring/dimension.h"
#include "app/control/scene_composer.h"
#include "core/camera_model.h"
#include "recon/appearance/orbit_camera.h"

namespace elbowroom::console {

// What lies over the picture and takes the left button before the view does: `press` says whether it does
// there, and then `drag` and `release` follow. `hover`: no button is pressed. Pixels as Clicked's.
struct ViewHandles {
  std::function<void(QPainter& painter, const recon::SceneView& view)> paint;  // the picture's corner is 0, 0
  std::function<void(const recon::SceneView& view, const Eigen::Vector2d& pixel)> hover;
  std::function<bool(const recon::SceneView& view, const Eigen::Vector2d& pixel)> press;
  std::function<void(const recon::SceneView& view, const Eigen::Vector2d& pixel, bool in_steps)> drag;
  std::function<void(bool is_kept)> release;  // not kept: Esc was pressed
};

// Left drag orbits, right or middle drag pans, the wheel zooms, a double click fits. Never waits for a
// picture: until the next one comes the last one is shown, scaled to the widget. One picture is asked for at
// a time, of the latest frame and camera, as fine as PicturePace allows; when nothing changes for a while,
// the scene is drawn once more in full. While it isn't visible nothing is drawn.
// Thread: UI.
class OperatorView : public QWidget {
  Q_OBJECT

 public:
  explicit OperatorView(QWidget* parent = nullptr);
  ~OperatorView() override;

  // Asks for a picture of it; the first one since Clear() is fitted to the view.
  void ShowFrame(control::SharedFrameResult result);
  void Foresee(const control::SharedHull& hull);  // of the frame that comes next
  void Clear();
  void Fit();  // everything in the picture, from the front, above

  void SetLook(const control::SceneLook& look);  // its hull
  // Null: no heat is shown. `of`: what it is of, for the legend.
  void SetHeat(control::SharedHeatLayer heat, const QString& of = {});
  void SetKnowledge(control::SharedRigKnowledge knowledge);  // of the rig, for looks that show it
  void SetCut(const control::SectionCut& cut);
  void SetHandles(ViewHandles handles) { handles_ = std::move(handles); }
  void SetDimensions(std::vector<control::Dimension> dimensions);  // written over the picture
  void LookAlong(recon::StandardView view);
  void SetParallel(bool is_parallel);
  void LookFrom(const core::CameraModel& camera);  // until the view is turned, which loses the camera's roll

  [[nodiscard]] QString driver() const;  // of OpenGL; "" until the first picture
  [[nodiscard]] const std::optional<recon::OrbitCamera>& camera() const { return camera_; }
  [[nodiscard]] const std::vector<ScaleLegend>& legends() const { return legends_; }
  [[nodiscard]] const control::SharedFrameResult& result() const { return result_; }
  [[nodiscard]] const control::SectionCut& cut() const { return look_.cut; }
  // Of the shown picture, in the widget's pixels from `picture_corner` on; nothing before the first picture.
  [[nodiscard]] std::optional<recon::SceneView> shown_view() const;
  [[nodiscard]] QPoint picture_corner() const { return PictureRect().topLeft(); }

 signals:
  void PictureShown(qint64 frame, double drawing_ms);  // it is drawn, and will be painted
  // Of live cameras: that picture was painted, so long after the middle of its frame's exposure.
  void PictureSeen(qint64 frame, double age_ms);
  void Failed(const QString& line);
  // The left button was pressed and let go at one place; `pixel` is one of the shown picture's view.
  void Clicked(const recon::SceneView& view, const Eigen::Vector2d& pixel);
  // A left drag with Shift, which doesn't turn the view: by so far, mm in world at the target's depth.
  void ShiftDragged(const Eigen::Vector3d& by_in_world_mm);
  void ShiftDragEnded();

 protected:
  void paintEvent(QPaintEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void TakeLook();
  void Turn(const recon::OrbitCamera& camera);
  void AskForPicture();
  [[nodiscard]] bool CanDraw() const;
  [[nodiscard]] std::optional<control::RenderRequest> Request(const QSize& size,
                                                              const PictureFineness& fineness) const;
  bool Take(const QImage& picture, const control::RenderRequest& request);
  void PaintCaption(QPainter& painter) const;
  [[nodiscard]] QRect PictureRect() const;
  [[nodiscard]] recon::SceneView ShownView() const;  // of the shown picture, in the widget's pixels
  [[nodiscard]] Eigen::Vector2d PixelAt(const QPointF& position) const;
  void TellAge();

  std::optional<recon::OrbitCamera> camera_;     // nothing until the first fit
  std::optional<core::CameraModel> looks_from_;  // takes camera_'s place
  bool is_parallel_ = false;
  control::SharedFrameResult result_;
  control::SceneLook look_;
  QString heat_of_;
  std::vector<ScaleLegend> legends_;  // of look_
  QImage picture_;
  qint64 picture_frame_ = 0;
  control::RenderRequest picture_request_;  // without its frame
  std::vector<control::Dimension> dimensions_;
  ViewHandles handles_;
  bool is_handle_held_ = false, is_shift_dragging_ = false;
  // When its frame was taken; nothing: of recorded footage, or its age was told.
  std::optional<std::chrono::steady_clock::time_point> taken_at_;
  QPointF last_mouse_px_, pressed_px_;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> fitting_;
  PictureAsker asker_;
};

}  // namespace elbowroom::console
