// The sessions that were opened last, over the program's runs.
#pragma once

#include <QMenu>
#include <QString>
#include <QStringList>
#include <filesystem>

namespace elbowroom::console {

// Paths of sessions that are still there, the last first.
[[nodiscard]] QStringList RecentSessions();
void RememberSession(const std::filesystem::path& session);

// Lists them anew each time it is opened. Thread: UI.
class RecentSessionsMenu : public QMenu {
  Q_OBJECT

 public:
  explicit RecentSessionsMenu(QWidget* parent = nullptr);

 signals:
  void Chosen(const QString& session);

 private:
  void List();
};

}  // namespace elbowroom::console
