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

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/console/view/operator_view.h"
#include "app/control/frame_result.h"
#include "app/control/measuring/dimension.h"
#include "app/control/measuring/measurement.h"
#include "app/control/picking/pick.h"
#include "app/control/section/section_cut.h"

namespace elbowroom::console {

// Measurements follow their parts from frame to frame; that to the hull, which takes a search, is found anew
// as often as the search takes, on a thread of its own. Thread: UI.
class MeasureTool : public QObject {
  Q_OBJECT

 public:
  explicit MeasureTool(OperatorView* view, QObject* parent = nullptr);
  ~MeasureTool() override;

  void Clear();  // another trial begins
  void ShowFrame(const control::SharedFrameResult& result);
  void SetCut(const control::SectionCut& cut) { cut_ = cut; }  // what is cut away can't be picked
  [[nodiscard]] const std::vector<QAction*>& actions() const { return actions_; }
  [[nodiscard]] const std::vector<control::Dimension>& dimensions() const { return shown_; }

 signals:
  void Advised(const QString& line);  // what to pick next; "": nothing

 private:
  struct PickedParts;  // trees, made once a mesh
  void MakeActions();
  void Begin(control::MeasurementKind kind);
  void Pick(const recon::SceneView& view, const Eigen::Vector2d& pixel);
  void Take(const control::Pick& pick);
  void AskHull();
  void Show();

  OperatorView* view_;
  std::vector<QAction*> actions_;
  QAction* clearances_ = nullptr;
  std::vector<QAction*> kinds_;
  std::optional<control::MeasurementKind> kind_;  // nothing: clicks pick nothing
  std::optional<control::SurfacePlace> first_;
  std::vector<control::Measurement> measurements_;
  std::optional<control::SurfacePlace> to_hull_;
  std::optional<control::Dimension> hull_distance_;
  control::SharedFrameResult result_;
  control::SectionCut cut_;
  std::vector<control::Dimension> shown_;
  std::shared_ptr<PickedParts> parts_;  // used by one job at a time
  Bridge bridge_;                       // before the threads that post to it
  std::unique_ptr<BackgroundJob> picking_, asking_;
};

}  // namespace elbowroom::console
