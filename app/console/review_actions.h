// What the user can do to review a session: one class each.
#pragma once

#include <QAction>
#include <QWidget>

#include "app/console/trial_desk.h"

namespace elbowroom::console {

class MainWindow;

// Asks for a session, and shows it on the review page.
class OpenSessionAction : public QAction {
 public:
  explicit OpenSessionAction(MainWindow* window);
};

// Shows the session of the trial that has just ended.
class ReviewTrialAction : public QAction {
 public:
  ReviewTrialAction(TrialDesk& desk, MainWindow* window);
};

}  // namespace elbowroom::console
