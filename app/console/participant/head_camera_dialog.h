// Where a camera on the participant's head is registered: its picture with the parts, moved until they fit.
#pragma once

#include <QDialog>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <memory>
#include <optional>
#include <vector>

#include "app/console/participant/head_camera_view.h"
#include "app/console/view/bridge.h"
#include "app/control/participant/participant_pictures.h"
#include "app/control/participant/scene_corners.h"
#include "recon/head_pose/head_camera.h"

namespace elbowroom::console {

// Works on one instant of the trial, until another one is taken. The parts are drawn on a thread of its own.
// Keys in the picture: arrows turn the camera, with Shift they move it, Page up and down nearer and farther;
// comma and full stop roll it; plus and minus: the focal length; with Alt a tenth of the step. Thread: UI.
class HeadCameraDialog : public QDialog {
  Q_OBJECT

 public:
  HeadCameraDialog(const recon::HeadCamera& camera, const QString& head_file, QWidget* parent);
  ~HeadCameraDialog() override;

  // An instant: what the cameras saw, and where the head was. `camera`: of the rig, from 0, for a trial
  // without a camera on the head.
  void Take(control::SharedFrameResult result, const control::HeadState& head, core::CameraIndex camera);

  [[nodiscard]] const recon::HeadCamera& camera() const { return camera_; }
  [[nodiscard]] HeadCameraView* view() { return view_; }

 signals:
  void TakeAsked();
  void Saved(const QString& head_file);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  struct Pair {
    QString part;
    Eigen::Vector3d x_in_world;
    std::optional<Eigen::Vector2d> pixel;  // nothing: it is the next that is clicked
  };

  [[nodiscard]] QWidget* MakePanel();
  [[nodiscard]] QDoubleSpinBox* AddStep(const char* name, double value, const QString& unit,
                                        const QString& spoken, const QString& tool_tip);
  QPushButton* AddButton(const char* name, const QString& text, const QString& tool_tip);
  void OpenPicture();
  void Ask();
  void ShowPicture(const control::ParticipantPicture& picture);
  void TakeClick(const QPointF& pixel);
  void RemovePair();
  void Fit();
  void Save();
  void Change(const recon::HeadCamera& camera);
  void ShowFigures();
  [[nodiscard]] bool TakeKey(int key, Qt::KeyboardModifiers modifiers);
  [[nodiscard]] std::vector<recon::SeenPoint> Points() const;
  [[nodiscard]] QString NextStep() const;

  recon::HeadCamera camera_;
  QString head_file_;
  control::ParticipantLook look_;
  control::SharedFrameResult result_;
  control::HeadState head_;
  std::vector<control::SceneCorner> corners_;
  std::vector<Pair> pairs_;
  HeadCameraView* view_;  // this and all below are owned by Qt as children
  QLabel* figures_;
  QLabel* next_;
  QListWidget* list_;
  QPushButton* marks_;
  QPushButton* fit_;
  QPushButton* save_;
  QDoubleSpinBox* step_px_;
  QDoubleSpinBox* step_mm_;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<control::ParticipantPictures> pictures_;
};

}  // namespace elbowroom::console
