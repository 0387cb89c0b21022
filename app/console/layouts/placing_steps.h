// What clicks place: to lay one part on another, a place on what moves, then one on what stays; or points
// that were measured.
#pragma once

#include <QObject>
#include <QString>
#include <optional>
#include <vector>

#include "app/control/picking/pick.h"
#include "core/layout.h"

namespace elbowroom::console {

enum class Placing { kNone, kFaceToFace, kHoleToHole, kMeasuredPoints };

// Thread: UI.
class PlacingSteps : public QObject {
  Q_OBJECT

 public:
  explicit PlacingSteps(QObject* parent = nullptr) : QObject(parent) {}

  void Begin(Placing placing);
  void End() { Begin(Placing::kNone); }
  [[nodiscard]] Placing placing() const { return placing_; }
  [[nodiscard]] QString Advice() const;  // what to click on next; "" if nothing

  // A click on a part of the layout, whose parts stand at these poses.
  void Take(const core::Layout& layout, const std::vector<core::RigidTransform>& world_from_parts,
            const control::Pick& pick);

 signals:
  void Changed();
  void Placed(const QString& part, const core::RigidTransform& world_from_part);
  void PointTaken(const control::Pick& pick);  // to be measured
  void Failed(const QString& line);

 private:
  struct First {
    QString part;
    control::Pick pick;
  };
  Placing placing_ = Placing::kNone;
  std::optional<First> first_;
};

}  // namespace elbowroom::console
