// What the experimenter can do with a trial: one class each.
#pragma once

#include <QAction>
#include <QWidget>
#include <filesystem>
#include <functional>

#include "app/console/desktop/session_place.h"
#include "app/console/spacing_panel.h"
#include "app/console/trial_desk.h"
#include "app/control/samples/sample_trial.h"

namespace elbowroom::console {

class StartDemoAction : public QAction {
 public:
  StartDemoAction(TrialDesk& desk, SessionPlace& place, QWidget* window);
};

// One of the paper's scenes, without cameras.
class StartSampleAction : public QAction {
 public:
  StartSampleAction(control::Sample sample, TrialDesk& desk, SessionPlace& place, QWidget* window);
};

class OpenTrialAction : public QAction {
 public:
  // `start`: what is done with the file that the user chooses.
  OpenTrialAction(TrialDesk& desk, std::function<void(const QString&)> start, QWidget* window);
};

// Asks for a CALIB.toml and a RIG.yml, and shows the calibration.
class CalibrateAction : public QAction {
 public:
  CalibrateAction(TrialDesk& desk, QWidget* window);
};

// Ends the trial under way, or gives up the report under way.
class StopAction : public QAction {
 public:
  StopAction(TrialDesk& desk, QWidget* window);
};

class ReportAction : public QAction {
 public:
  ReportAction(TrialDesk& desk, QWidget* window);
};

// Back to the gap before the last change, and forth again.
class UndoGapAction : public QAction {
 public:
  UndoGapAction(SpacingPanel& spacings, QWidget* window);
};

class RedoGapAction : public QAction {
 public:
  RedoGapAction(SpacingPanel& spacings, QWidget* window);
};

// Chooses the folder for sessions.
class SessionsFolderAction : public QAction {
 public:
  explicit SessionsFolderAction(QWidget* window);
};

// What the actions do: start a trial that is recorded at the next place. Throw: what SessionPlace::Next
// throws.
void StartDemo(TrialDesk& desk, SessionPlace& place);
void StartSample(control::Sample sample, TrialDesk& desk, SessionPlace& place);
// `change`: what is set in the trial after its file was read, on a worker; empty: nothing.
void StartTrialFile(TrialDesk& desk, const std::filesystem::path& trial_file, SessionPlace& place,
                    std::function<void(control::TrialSetup*)> change = {});

}  // namespace elbowroom::console
