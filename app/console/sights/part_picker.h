// Which part, and which of its faces, is under a pixel of the 3-D view.
#pragma once

#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <optional>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/console/view/operator_view.h"
#include "app/control/picking/pick.h"

namespace elbowroom::console {

// Picks in the view's latest frame, of cut parts what is left of them, with the faces of the cut. A thread of
// its own makes the trees of the meshes, and looks. Thread: UI.
class PartPicker : public QObject {
  Q_OBJECT

 public:
  using Take = std::function<void(const std::optional<control::Pick>& pick)>;  // nothing: no part is there

  explicit PartPicker(const OperatorView* view, QObject* parent = nullptr);
  ~PartPicker() override;

  void Forget();  // another trial begins
  // `pixel`: of the view's shown picture, as OperatorView::Clicked has it. False while another one is looked
  // for, and where there is no frame.
  bool Pick(const recon::SceneView& view, const Eigen::Vector2d& pixel, Take take);

 signals:
  void Failed(const QString& line);

 private:
  struct PickedParts;  // trees, made once a mesh
  const OperatorView* view_;
  std::shared_ptr<PickedParts> parts_;  // used by one job at a time
  Bridge bridge_;                       // before the thread that posts to it
  std::unique_ptr<BackgroundJob> picking_;
};

}  // namespace elbowroom::console
