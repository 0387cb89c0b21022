// Section planes in a 3-D view: it is cut by the panel's planes, and has handles at the active one.
#pragma once

#include <QObject>
#include <optional>

#include "app/console/sights/part_picker.h"
#include "app/console/sights/plane_handles.h"
#include "app/console/sights/section_panel.h"
#include "app/console/view/operator_view.h"

namespace elbowroom::console {

// All four live as long as their window. Thread: UI.
class SectionTool : public QObject {
  Q_OBJECT

 public:
  SectionTool(SectionPanel* panel, OperatorView* view, PartPicker* picker, QObject* parent = nullptr);

  // Where the view shows a handle of the active plane, in its own pixels; nothing where there is none.
  [[nodiscard]] std::optional<QPointF> GripOf(PlaneHandle handle) const;

 signals:
  void Advised(const QString& line);  // what to click on next; "": nothing

 private:
  [[nodiscard]] std::optional<PlaneHandles> Handles() const;
  [[nodiscard]] ViewHandles HandlesForView();
  bool Press(const recon::SceneView& view, const Eigen::Vector2d& pixel);
  void Hover(const recon::SceneView& view, const Eigen::Vector2d& pixel);
  void Release(bool is_kept);
  void AddFacing();
  void BeginAligning(bool is_on);
  void PickFace(const recon::SceneView& view, const Eigen::Vector2d& pixel);

  SectionPanel* panel_;
  OperatorView* view_;
  PartPicker* picker_;
  bool is_aligning_ = false;
  std::optional<PlaneHandle> hot_;  // under the pointer, or dragged
  std::optional<PlaneDrag> drag_;
};

}  // namespace elbowroom::console
