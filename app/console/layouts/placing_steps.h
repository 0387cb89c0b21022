// What clicks place: to lay one part on another, a place on what moves, then one on what stays; or points
// that were measured.
#pragma once

#include <QObject>
#include <QString>
#include <memory>
#include <optional>
#include <vector>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/picking/pick.h"
#include "app/control/placing/drag.h"
#include "core/layout.h"

namespace elbowroom::console {

enum class Placing { kNone, kFaceToFace, kHoleToHole, kMeasuredPoints };

// Thread: UI.
class PlacingSteps : public QObject {
  Q_OBJECT

 public:
  explicit PlacingSteps(QObject* parent = nullptr);
  ~PlacingSteps() override;

  void Begin(Placing placing);
  void End() { Begin(Placing::kNone); }
  [[nodiscard]] Placing placing() const { return placing_; }
  [[nodiscard]] QString Advice() const;  // what to click on next; "" if nothing

  // A click on a part of the layout, whose parts stand at these poses. The axis of a hole is found by a
  // worker: until then other clicks do nothing, and Begin() and End() give it up.
  void Take(const core::Layout& layout, const std::vector<core::RigidTransform>& world_from_parts,
            const control::Pick& pick);

 signals:
  void Changed();
  void Placed(const QString& part, const core::RigidTransform& world_from_part);
  void PointTaken(const control::Pick& pick);  // to be measured
  void Failed(const QString& line);

 private:
  struct Click {
    QString part;
    core::RigidTransform world_from_part;
    control::Pick pick;
    control::AxisLine axis;  // only for holes
  };
  void FindAxis(const core::SharedMesh& mesh, const Click& click);
  void TakeClick(const Click& click);

  Placing placing_ = Placing::kNone;
  std::optional<Click> first_;
  int runs_ = 0;   // of placing
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> finding_;
};

}  // namespace elbowroom::console
