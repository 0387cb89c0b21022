// The middle of the trial page: the 3-D view or a camera's picture, and how one looks at them.
#pragma once

#include <QAction>
#include <QLabel>
#include <QMenu>
#include <QStackedWidget>
#include <QToolButton>
#include <QWidget>
#include <optional>
#include <vector>

#include "app/console/sights/camera_view.h"
#include "app/console/sights/measure_tool.h"
#include "app/console/sights/part_picker.h"
#include "app/console/sights/section_tool.h"
#include "app/console/view/operator_view.h"
#include "app/control/layers/heat_layer.h"
#include "app/control/tiles/tile_maker.h"
#include "app/control/trial_setup.h"
#include "core/rig.h"

namespace elbowroom::console {

// Owns the operator's view. Thread: UI.
class TrialSights : public QWidget {
  Q_OBJECT

 public:
  explicit TrialSights(OperatorView* view, QWidget* parent = nullptr);

  void Open(const control::TrialSetup& setup);
  void ShowFrame(const control::SharedFrameResult& result);
  void ShowHeat(const control::SharedHeatLayer& heat);  // if the operator wants to see it
  void ShowTiles(const control::SharedTiles& tiles);
  void SetTileRoom(const control::ThumbnailRoom& room);  // of the strip's pictures
  void ShowCamera(int camera);                           // its picture, large
  void ShowScene();                                      // the 3-D view

  // For the window's menu: standard views, parallel projection, parts in the pictures, cameras.
  void AddTo(QMenu* menu);

  [[nodiscard]] const MeasureTool& measure() const { return *measure_; }
  [[nodiscard]] const SectionTool& section() const { return *section_tool_; }
  [[nodiscard]] CameraView& camera_view() { return *camera_view_; }
  [[nodiscard]] const control::TileWishes& wishes() const { return wishes_; }

 signals:
  void HeatWished(bool is_wished);
  void Failed(const QString& line);
  void WishesChanged(const elbowroom::control::TileWishes& wishes);

 private:
  void MakeViewActions();
  void MakeSectionAction();
  void MakeHeatAction();
  void FollowMeasure();
  void MakeCameraMenu();
  void MakeBar();
  void TellWishes();

  OperatorView* view_;
  CameraView* camera_view_;
  QStackedWidget* stack_;
  SectionPanel* section_panel_;
  PartPicker* picker_;  // before those that ask it
  SectionTool* section_tool_;
  MeasureTool* measure_;
  QLabel* advice_;
  std::vector<QAction*> standard_;
  QAction* parallel_ = nullptr;
  QAction* parts_ = nullptr;
  QAction* section_ = nullptr;
  QAction* heat_ = nullptr;
  QMenu* cameras_ = nullptr;
  std::vector<core::CameraModel> rig_;
  control::TileWishes wishes_;
};

}  // namespace elbowroom::console
