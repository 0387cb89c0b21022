#include "app/console/camera_actions.h"

#include <QDateTime>

#include "app/console/background_dialog.h"

namespace elbowroom::console {
namespace {

// "": nothing is in the way.
QString WhyNot(const TrialDesk& desk, const PreflightPanel& panel) {
  if (desk.state() == DeskState::kRunning || desk.state() == DeskState::kReading)
    return QObject::tr("The running trial has the cameras: stop it first");
  if (desk.are_cameras_taken()) return QObject::tr("The cameras are in use: wait, or cancel");
  if (!panel.rig()) return QObject::tr("Choose a trial or a rig in the preflight panel first");
  if (!panel.rig()->is_live)
    return QObject::tr("The rig plays recorded files: only live cameras can take a background");
  return {};
}

std::filesystem::path ProposedFolder(const control::PreflightRig& rig) {
  const QString name = "background-" + QDateTime::currentDateTime().toString("yyyyMMdd-hhmmss");
  return std::filesystem::absolute(rig.path).parent_path() / name.toStdString();
}

}  // namespace

TakeBackgroundAction::TakeBackgroundAction(TrialDesk& desk, PreflightPanel& panel, QWidget* window)
    : QAction(tr("Take &background …"), window) {
  connect(this, &QAction::triggered, window, [&desk, &panel, window] {
    auto* dialog = new BackgroundDialog(panel.rig()->rig_file, ProposedFolder(*panel.rig()), window);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &BackgroundDialog::Began, &desk, [&desk] { desk.SetCamerasTaken(true); });
    connect(dialog, &BackgroundDialog::Ended, &desk, [&desk] { desk.SetCamerasTaken(false); });
    connect(dialog, &BackgroundDialog::Taken, &panel,
            [&panel](const QString& rig_file) { panel.Open(rig_file.toStdString()); });
    dialog->show();
  });
  const auto follow = [this, &desk, &panel] {
    const QString why_not = WhyNot(desk, panel);
    setEnabled(why_not.isEmpty());
    setToolTip(why_not.isEmpty() ? tr("Take the empty scene with the rig's live cameras") : why_not);
  };
  connect(&desk, &TrialDesk::StateChanged, this, follow);
  connect(&panel, &PreflightPanel::RigChanged, this, follow);
  follow();
}

}  // namespace elbowroom::console
