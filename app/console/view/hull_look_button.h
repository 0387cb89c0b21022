// The choice of how the hull is coloured in a 3-D view.
#pragma once

#include <QAction>
#include <QToolButton>
#include <utility>
#include <vector>

#include "app/control/scene_composer.h"

namespace elbowroom::console {

// Recorded sessions have no pictures to take colours from.
enum class LooksOffered { kAll, kWithoutPictures };

// A button with a menu of the looks, one of them checked. A look at what is known of the rig that is chosen
// once more gives way to the shaded one. Thread: UI.
class HullLookButton : public QToolButton {
  Q_OBJECT

 public:
  explicit HullLookButton(LooksOffered offered = LooksOffered::kAll, QWidget* parent = nullptr);

  // Turns the look on, or off if it is on.
  void Toggle(recon::HullAppearance appearance);
  // Those of the looks at what is known of the rig, which have keys while a window holds the button.
  [[nodiscard]] std::vector<QAction*> KnowledgeActions() const;

 signals:
  void Chosen(const control::SceneLook& look);  // its hull; nothing else of it

 private:
  void Choose(recon::HullAppearance appearance);

  std::vector<std::pair<recon::HullAppearance, QAction*>> looks_;
  recon::HullAppearance chosen_ = control::SceneLook{}.hull;
};

}  // namespace elbowroom::console
