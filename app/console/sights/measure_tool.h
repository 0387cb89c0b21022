// Picks places on parts, measures between them and to the hull, and writes the lengths into the 3-D view.
#pragma once

#include <Eigen/Core>
#include <QAction>
#include <QMenu>
#include <QObject>
#include <QString>
#include <memory>
#include <optional>
#include <vector>

#include "app/console/sights/part_picker.h"
#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/console/view/operator_view.h"
#include "app/control/frame_result.h"
#include "app/control/measuring/dimension.h"
#include "app/control/measuring/measurement.h"
#include "app/control/picking/pick.h"

namespace elbowroom::console {

// Measurements follow their parts from frame to frame; that to the hull, which takes a search, is found anew
// as often as the search takes, on a thread of its own. Thread: UI.
class MeasureTool : public QObject {
  Q_OBJECT

 public:
  MeasureTool(OperatorView* view, PartPicker* picker, QObject* parent = nullptr);
  ~MeasureTool() override;

  void Clear();  // another trial begins
  void End();    // clicks pick nothing
  void ShowFrame(const control::SharedFrameResult& result);
  [[nodiscard]] const std::vector<QAction*>& actions() const { return actions_; }
  [[nodiscard]] const std::vector<control::Dimension>& dimensions() const { return shown_; }

 signals:
  void Advised(const QString& line);  // what to pick next; "": nothing
  void Begun();                       // clicks pick for a measurement
  void Failed(const QString& line);

 private:
  void MakeActions();
  void Begin(control::MeasurementKind kind);
  void Pick(const recon::SceneView& view, const Eigen::Vector2d& pixel);
  void Take(const control::Pick& pick);
  void AskHull();
  void Show();

  OperatorView* view_;
  PartPicker* picker_;
  std::vector<QAction*> actions_;
  QAction* clearances_ = nullptr;
  std::vector<QAction*> kinds_;
  std::optional<control::MeasurementKind> kind_;  // nothing: clicks pick nothing
  std::optional<control::SurfacePlace> first_;
  std::vector<control::Measurement> measurements_;
  std::optional<control::SurfacePlace> to_hull_;
  std::optional<control::Dimension> hull_distance_;
  control::SharedFrameResult result_;
  std::vector<control::Dimension> shown_;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> asking_;
};

}  // namespace elbowroom::console
