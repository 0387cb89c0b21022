// What stands in the window before the first trial.
#pragma once

#include <QAction>
#include <QVBoxLayout>
#include <QWidget>

namespace elbowroom::console {

// Buttons for the actions with which one can begin, and the trials that were opened last. Thread: UI.
class WelcomePage : public QWidget {
  Q_OBJECT

 public:
  WelcomePage(QAction* demo, QAction* open, QWidget* parent = nullptr);

  // A row of smaller buttons below the first one.
  void AddSamples(const QList<QAction*>& samples);

 signals:
  void TrialChosen(const QString& trial_file);

 private:
  void AddButton(QAction* action, const QString& explanation);
  void AddRecentTrials();

  QVBoxLayout* column_;  // owned by Qt
};

}  // namespace elbowroom::console
