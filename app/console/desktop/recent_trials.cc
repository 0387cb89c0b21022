#include "app/console/desktop/recent_trials.h"

#include <QDir>
#include <QFileInfo>
#include <QSettings>

namespace elbowroom::console {
namespace {

constexpr const char* kTrialsKey = "recent/trials";

}  // namespace

QStringList RecentTrials() {
  QStringList trials = QSettings().value(kTrialsKey).toStringList();
  trials.removeIf([](const QString& file) { return !QFileInfo::exists(file); });
  return trials;
}

void RememberTrial(const QString& trial_file) {
  QStringList trials = RecentTrials();
  const QString path = QFileInfo(trial_file).absoluteFilePath();
  trials.removeAll(path);
  trials.prepend(path);
  QSettings().setValue(kTrialsKey, trials.mid(0, kMostRecentTrials));
}

RecentTrialsMenu::RecentTrialsMenu(QWidget* parent) : QMenu(tr("Open &recent"), parent) {
  setToolTipsVisible(true);
  connect(this, &QMenu::aboutToShow, this, &RecentTrialsMenu::List);
  List();
}

void RecentTrialsMenu::List() {
  clear();
  for (const QString& file : RecentTrials()) {
    const QFileInfo info(file);
    QAction* action = addAction(info.dir().dirName() + "/" + info.fileName());
    action->setToolTip(QDir::toNativeSeparators(file));
    connect(action, &QAction::triggered, this, [this, file] { emit Chosen(file); });
  }
  if (isEmpty()) addAction(tr("No trial was opened yet"))->setEnabled(false);
}

}  // namespace elbowroom::console
