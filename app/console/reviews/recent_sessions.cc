#include "app/console/reviews/recent_sessions.h"

#include <QDir>
#include <QFileInfo>
#include <QSettings>

namespace elbowroom::console {
namespace {

constexpr const char* kSessionsKey = "recent/sessions";
constexpr int kMostRecentSessions = 8;

}  // namespace

QStringList RecentSessions() {
  QStringList sessions = QSettings().value(kSessionsKey).toStringList();
  sessions.removeIf([](const QString& file) { return !QFileInfo::exists(file); });
  return sessions;
}

void RememberSession(const std::filesystem::path& session) {
  QStringList sessions = RecentSessions();
  const QString path = QFileInfo(QString::fromStdString(session.string())).absoluteFilePath();
  sessions.removeAll(path);
  sessions.prepend(path);
  QSettings().setValue(kSessionsKey, sessions.mid(0, kMostRecentSessions));
}

RecentSessionsMenu::RecentSessionsMenu(QWidget* parent) : QMenu(tr("Recent s&essions"), parent) {
  setToolTipsVisible(true);
  connect(this, &QMenu::aboutToShow, this, &RecentSessionsMenu::List);
  List();
}

void RecentSessionsMenu::List() {
  clear();
  for (const QString& file : RecentSessions()) {
    QAction* action = addAction(QFileInfo(file).fileName());
    action->setToolTip(QDir::toNativeSeparators(file));
    connect(action, &QAction::triggered, this, [this, file] { emit Chosen(file); });
  }
  if (isEmpty()) addAction(tr("No session was opened yet"))->setEnabled(false);
}

}  // namespace elbowroom::console
