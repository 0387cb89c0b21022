// What the experimenter can do with the cameras before a trial.
#pragma once

#include <QAction>
#include <QWidget>

#include "app/console/preflight_panel.h"
#include "app/console/trial_desk.h"

namespace elbowroom::console {

// Takes the empty scene with the panel's rig. While it can't, its tool tip says why.
class TakeBackgroundAction : public QAction {
 public:
  TakeBackgroundAction(TrialDesk& desk, PreflightPanel& panel, QWidget* window);
};

}  // namespace elbowroom::console
