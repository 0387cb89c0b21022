#include "app/console/review_actions.h"

#include <QStyle>

#include "app/console/main_window.h"

namespace elbowroom::console {

OpenSessionAction::OpenSessionAction(MainWindow* window) : QAction(tr("Open &session …"), window) {
  setObjectName("open_session");
  setShortcut(QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_O));
  setToolTip(tr("Review a session (.db) that a trial or a replay recorded"));
  connect(this, &QAction::triggered, window, &MainWindow::AskForSession);
}

ReviewTrialAction::ReviewTrialAction(TrialDesk& desk, MainWindow* window) : QAction(tr("Re&view"), window) {
  setObjectName("review_trial");
  setIcon(window->style()->standardIcon(QStyle::SP_FileDialogInfoView));
  setToolTip(
      tr("Go through the trial that has just ended: its touches, and what another gap would have done"));
  connect(this, &QAction::triggered, window, [&desk, window] { window->OpenSession(desk.session()); });
  const auto follow = [this, &desk] { setEnabled(desk.can_report()); };
  connect(&desk, &TrialDesk::StateChanged, this, follow);
  follow();
}

}  // namespace elbowroom::console
