// The trials that were opened last, over the program's runs.
#pragma once

#include <QMenu>
#include <QStringList>

namespace elbowroom::console {

inline constexpr int kMostRecentTrials = 8;

// Paths of TRIAL.toml files that are still there, the last first.
[[nodiscard]] QStringList RecentTrials();
void RememberTrial(const QString& trial_file);

// Lists them anew each time it is opened. Thread: UI.
class RecentTrialsMenu : public QMenu {
  Q_OBJECT

 public:
  explicit RecentTrialsMenu(QWidget* parent = nullptr);

 signals:
  void Chosen(const QString& trial_file);

 private:
  void List();
};

}  // namespace elbowroom::console
