// The choice of how the hull is coloured in the operator's view.
#pragma once

#include <QToolButton>

#include "app/control/scene_composer.h"

namespace elbowroom::console {

// A button with a menu of the looks, one of them checked. Thread: UI.
class HullLookButton : public QToolButton {
  Q_OBJECT

 public:
  explicit HullLookButton(QWidget* parent = nullptr);

 signals:
  void Chosen(const control::SceneLook& look);

 private:
  void Choose(const QString& name, const control::SceneLook& look);
};

}  // namespace elbowroom::console
