#include "app/console/trial_actions.h"

#include <QDesktopServices>
#include <QDir>
#include <QFileInfo>
#include <QStyle>
#include <QUrl>
#include <utility>

#include "app/console/calibration_dialog.h"
#include "app/console/desktop/recent_trials.h"
#include "app/console/view/file_question.h"
#include "app/control/demo_trial.h"

namespace elbowroom::console {
namespace {

std::filesystem::path PathFrom(const QString& text) { return text.toStdString(); }

void Calibrate(const QString& file, const QString& rig, QWidget* window) {
  auto* dialog = new CalibrationDialog(PathFrom(file), PathFrom(rig), window);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->show();  // a trial may have begun meanwhile
}

void AskToCalibrate(QWidget* window) {
  AskForFileToRead(
      window,
      {.title = QObject::tr("Calibrate from"), .filter = QObject::tr("Calibrations (*.toml);;All files (*)")},
      [window](const QString& file) {
        AskForFileToWrite(window,
                          {.title = QObject::tr("Write the rig into"),
                           .beside = QFileInfo(file).dir().filePath("rig.yml"),
                           .filter = QObject::tr("Rigs (*.yml)"),
                           .suffix = "yml"},
                          [window, file](const QString& rig) { Calibrate(file, rig, window); });
      });
}

// Enabled whenever `is_possible` says so after a change of the desk's state.
template <typename IsPossible>
void EnableWhile(QAction* action, TrialDesk& desk, IsPossible is_possible) {
  const auto follow = [action, &desk, is_possible] { action->setEnabled(is_possible(desk)); };
  QObject::connect(&desk, &TrialDesk::StateChanged, action, follow);
  follow();
}

// Enabled while gaps can be set and their history allows it.
void EnableWhileGapsCan(QAction* action, SpacingPanel& spacings, bool (GapHistory::*is_possible)() const) {
  const auto follow = [action, &spacings, is_possible] {
    action->setEnabled(spacings.isEnabled() && (spacings.history().*is_possible)());
  };
  QObject::connect(&spacings, &SpacingPanel::HistoryChanged, action, follow);
  follow();
}

bool IsIdle(const TrialDesk& desk) { return desk.state() == DeskState::kIdle; }
bool CanStart(const TrialDesk& desk) { return IsIdle(desk) && !desk.are_cameras_taken(); }

}  // namespace

void StartDemo(TrialDesk& desk, SessionPlace& place) {
  desk.Start([](const std::stop_token&) { return control::MakeDemoTrial(control::DemoPlay::kForever); },
             place.Next());
}

void StartSample(control::Sample sample, TrialDesk& desk, SessionPlace& place) {
  desk.Start([sample](const std::stop_token&) { return control::MakeSampleTrial(sample); }, place.Next());
}

void StartTrialFile(TrialDesk& desk, const std::filesystem::path& trial_file, SessionPlace& place,
                    std::function<void(control::TrialSetup*)> change) {
  desk.Start(
      [trial_file, change = std::move(change)](const std::stop_token& stop) {
        control::TrialSetup setup = control::ReadTrialFile(trial_file, stop);
        if (change) change(&setup);
        return setup;
      },
      place.Next(), trial_file);
  RememberTrial(QString::fromStdString(trial_file.string()));
}

StartDemoAction::StartDemoAction(TrialDesk& desk, SessionPlace& place, QWidget* window)
    : QAction(tr("Start &demo"), window) {
  setToolTip(tr("Play the built-in trial: a simulated hand at the PMT box, payload A above it"));
  connect(this, &QAction::triggered, window, [&desk, &place] { StartDemo(desk, place); });
  EnableWhile(this, desk, IsIdle);
}

StartSampleAction::StartSampleAction(control::Sample sample, TrialDesk& desk, SessionPlace& place,
                                     QWidget* window)
    : QAction(window) {
  switch (sample) {
    case control::Sample::kPayload:
      setText(tr("&Payload task"));
      setToolTip(tr("A hand screws a pipe in below a payload: the demo"));
      break;
    case control::Sample::kCurtain:
      setText(tr("&Curtain"));
      setToolTip(tr("Two hands push a curtain before a window aside"));
      break;
    case control::Sample::kFaucet:
      setText(tr("&Faucet"));
      setToolTip(tr("Two cupped hands catch the water of a faucet"));
      break;
  }
  connect(this, &QAction::triggered, window, [sample, &desk, &place] { StartSample(sample, desk, place); });
  EnableWhile(this, desk, IsIdle);
}

OpenTrialAction::OpenTrialAction(TrialDesk& desk, std::function<void(const QString&)> start, QWidget* window)
    : QAction(window->style()->standardIcon(QStyle::SP_DialogOpenButton), tr("&Open trial …"), window) {
  setShortcut(QKeySequence::Open);
  setToolTip(tr("Run the trial that a TRIAL.toml describes"));
  connect(this, &QAction::triggered, window, [&desk, start = std::move(start), window] {
    const QString last = desk.trial_file().empty() ? RecentTrials().value(0)
                                                   : QString::fromStdString(desk.trial_file().string());
    AskForFileToRead(
        window, {.title = tr("Open a trial"), .beside = last, .filter = tr("Trials (*.toml);;All files (*)")},
        start);
  });
  EnableWhile(this, desk, CanStart);
}

SessionsFolderAction::SessionsFolderAction(QWidget* window) : QAction(tr("&Sessions folder …"), window) {
  setToolTip(tr("Choose where the next trials are recorded"));
  connect(this, &QAction::triggered, window, [window] {
    AskForFolder(
        window,
        {.title = tr("Record sessions into"), .beside = QString::fromStdString(SessionsFolder().string())},
        [](const QString& folder) { SetSessionsFolder(PathFrom(folder)); });
  });
}

CalibrateAction::CalibrateAction(TrialDesk& desk, QWidget* window)
    : QAction(window->style()->standardIcon(QStyle::SP_FileDialogContentsView), tr("&Calibrate …"), window) {
  setToolTip(tr("Find the cameras' lenses and places from pictures of a board, as a CALIB.toml says"));
  connect(this, &QAction::triggered, window, [window] { AskToCalibrate(window); });
  EnableWhile(this, desk, IsIdle);
}

StopAction::StopAction(TrialDesk& desk, QWidget* window) : QAction(tr("&Stop"), window) {
  setToolTip(tr("End the trial; its session is complete up to this frame"));
  connect(this, &QAction::triggered, &desk, &TrialDesk::Stop);
  EnableWhile(this, desk, [](const TrialDesk& at) { return !IsIdle(at) && !at.is_stopping(); });
}

ReportAction::ReportAction(TrialDesk& desk, QWidget* window)
    : QAction(window->style()->standardIcon(QStyle::SP_FileDialogDetailedView), tr("&Report"), window) {
  setToolTip(tr("Write the last trial's report beside its session, and open it"));
  connect(this, &QAction::triggered, &desk, &TrialDesk::WriteReport);
  connect(&desk, &TrialDesk::ReportWritten, window,
          [](const QString& html_file) { QDesktopServices::openUrl(QUrl::fromLocalFile(html_file)); });
  EnableWhile(this, desk, [](const TrialDesk& at) { return at.can_report(); });
}

UndoGapAction::UndoGapAction(SpacingPanel& spacings, QWidget* window)
    : QAction(window->style()->standardIcon(QStyle::SP_ArrowBack), tr("&Undo gap"), window) {
  setShortcut(QKeySequence::Undo);
  setToolTip(tr("Back to the gap before the last change (%1); the session records it as one more change")
                 .arg(shortcut().toString(QKeySequence::NativeText)));
  connect(this, &QAction::triggered, &spacings, &SpacingPanel::Undo);
  EnableWhileGapsCan(this, spacings, &GapHistory::CanUndo);
}

RedoGapAction::RedoGapAction(SpacingPanel& spacings, QWidget* window)
    : QAction(window->style()->standardIcon(QStyle::SP_ArrowForward), tr("&Redo gap"), window) {
  setShortcut(QKeySequence::Redo);
  setToolTip(tr("The gap that was undone (%1)").arg(shortcut().toString(QKeySequence::NativeText)));
  connect(this, &QAction::triggered, &spacings, &SpacingPanel::Redo);
  EnableWhileGapsCan(this, spacings, &GapHistory::CanRedo);
}

}  // namespace elbowroom::console
