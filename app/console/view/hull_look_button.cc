#include "app/console/view/hull_look_button.h"

#include <QActionGroup>
#include <QMenu>
#include <algorithm>
#include <array>

#include "app/control/layers/hull_colors.h"

namespace elbowroom::console {
namespace {

using Appearance = recon::HullAppearance;

struct Look {
  Appearance appearance;
  const char* name;
  const char* tool_tip;
  const char* object_name;
  Qt::Key key;  // Key_unknown: none
};

constexpr std::array kLooks = {
    Look{Appearance::kFlat, QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "flat"),
         QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "One colour, as the paper's glove"),
         "look_flat", Qt::Key_unknown},
    Look{Appearance::kByNormal, QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "shaded"),
         QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "One colour, lit by the lamp"),
         "look_shaded", Qt::Key_unknown},
    Look{Appearance::kOneCamera, QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "nearest camera"),
         QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "Colours of the camera next to the view"),
         "look_one_camera", Qt::Key_unknown},
    Look{Appearance::kRigCameras, QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "camera colours"),
         QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "Colours of all cameras of the rig"),
         "look_rig_cameras", Qt::Key_unknown},
    Look{Appearance::kCoverage, QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "coverage"),
         QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton",
                           "How many cameras see each place of the surface, nothing real before it"),
         "look_coverage", Qt::Key_V},
    Look{Appearance::kUncertainty, QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton", "uncertainty"),
         QT_TRANSLATE_NOOP("elbowroom::console::HullLookButton",
                           "How far the surface may be off there, in mm (2 sigma): calibration and pixels"),
         "look_uncertainty", Qt::Key_U}};

bool NeedsPictures(Appearance appearance) {
  return recon::HasPixelColors(appearance) && !control::ShowsKnowledge(appearance);
}

}  // namespace

HullLookButton::HullLookButton(LooksOffered offered, QWidget* parent) : QToolButton(parent) {
  setPopupMode(QToolButton::InstantPopup);
  setToolTip(tr("How the hull of what is real is coloured"));
  auto* menu = new QMenu(this);
  menu->setToolTipsVisible(true);
  auto* group = new QActionGroup(this);
  for (const Look& look : kLooks) {
    if (offered == LooksOffered::kWithoutPictures && NeedsPictures(look.appearance)) continue;
    QAction* action = menu->addAction(tr(look.name));
    // Both pages of a window have such a button.
    const char* page = offered == LooksOffered::kAll ? "" : "review_";
    action->setObjectName(QString(page) + look.object_name);
    action->setToolTip(tr(look.tool_tip));
    action->setCheckable(true);
    if (offered == LooksOffered::kAll && look.key != Qt::Key_unknown)
      action->setShortcut(QKeySequence(look.key));
    group->addAction(action);
    connect(action, &QAction::triggered, this, [this, appearance = look.appearance] { Toggle(appearance); });
    looks_.emplace_back(look.appearance, action);
  }
  setMenu(menu);
  Choose(chosen_);
}

std::vector<QAction*> HullLookButton::KnowledgeActions() const {
  std::vector<QAction*> actions;
  for (const auto& [appearance, action] : looks_)
    if (control::ShowsKnowledge(appearance)) actions.push_back(action);
  return actions;
}

void HullLookButton::Toggle(Appearance appearance) {
  const bool is_on = appearance == chosen_ && control::ShowsKnowledge(appearance);
  Choose(is_on ? control::SceneLook{}.hull : appearance);
}

void HullLookButton::Choose(Appearance appearance) {
  chosen_ = appearance;
  QAction* action =
      std::ranges::find(looks_, appearance, [](const auto& look) { return look.first; })->second;
  action->setChecked(true);
  setText(tr("Hull: %1").arg(action->text()));
  emit Chosen(control::SceneLook{appearance});
}

}  // namespace elbowroom::console
