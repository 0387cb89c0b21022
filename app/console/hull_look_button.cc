#include "app/console/hull_look_button.h"

#include <QActionGroup>
#include <QMenu>
#include <array>
#include <utility>

namespace elbowroom::console {

HullLookButton::HullLookButton(QWidget* parent) : QToolButton(parent) {
  using Appearance = recon::HullAppearance;
  setPopupMode(QToolButton::InstantPopup);
  setToolTip(tr("How the hull of what is real is coloured"));
  auto* menu = new QMenu(this);
  auto* group = new QActionGroup(this);
  const std::array<std::pair<QString, Appearance>, 4> looks{
      {{tr("flat"), Appearance::kFlat},
       {tr("shaded"), Appearance::kByNormal},
       {tr("nearest camera"), Appearance::kOneCamera},
       {tr("camera colours"), Appearance::kRigCameras}}};
  for (const auto& [name, appearance] : looks) {
    QAction* action = menu->addAction(name);
    action->setCheckable(true);
    group->addAction(action);
    const control::SceneLook look{appearance};
    connect(action, &QAction::triggered, this, [this, text = name, look] { Choose(text, look); });
    if (look != control::SceneLook{}) continue;
    action->setChecked(true);
    setText(tr("Hull: %1").arg(name));
  }
  setMenu(menu);
}

void HullLookButton::Choose(const QString& name, const control::SceneLook& look) {
  setText(tr("Hull: %1").arg(name));
  emit Chosen(look);
}

}  // namespace elbowroom::console
