// What the experimenter can do with a trial: one class each.
#pragma once

#include <QAction>
#include <QWidget>
#include <filesystem>
#include <optional>

#include "app/console/spacing_panel.h"
#include "app/console/trial_desk.h"

namespace elbowroom::console {

// Where the next trial is recorded: the path given beforehand, once; else the user is asked.
class SessionChoice {
 public:
  explicit SessionChoice(std::filesystem::path given) : given_(std::move(given)) {}

  // Nothing if the user cancels.
  [[nodiscard]] std::optional<std::filesystem::path> Choose(QWidget* window);

 private:
  std::filesystem::path given_;  // empty: none, or used up
};

// "elbowroom-20250131-093000.db" at local time.
[[nodiscard]] QString DefaultSessionName(const QDateTime& at);

class StartDemoAction : public QAction {
 public:
  StartDemoAction(TrialDesk& desk, SessionChoice& choice, QWidget* window);
};

class OpenTrialAction : public QAction {
 public:
  OpenTrialAction(TrialDesk& desk, SessionChoice& choice, QWidget* window);
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

// What the actions do once the session's path is known.
void StartDemo(TrialDesk& desk, const std::filesystem::path& session);
void StartTrialFile(TrialDesk& desk, const std::filesystem::path& trial_file,
                    const std::filesystem::path& session);

}  // namespace elbowroom::console
