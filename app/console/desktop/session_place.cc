#include "app/console/desktop/session_place.h"

#include <QDir>
#include <QSettings>
#include <QStandardPaths>
#include <utility>

#include "core/system/file_sync.h"

namespace elbowroom::console {
namespace {

constexpr const char* kFolderKey = "sessions/folder";

std::filesystem::path PathFrom(const QString& text) { return text.toStdString(); }

}  // namespace

QString DefaultSessionName(const QDateTime& at) {
  return "elbowroom-" + at.toString("yyyyMMdd-hhmmss") + ".db";
}

std::filesystem::path SessionsFolder() {
  const QString chosen = QSettings().value(kFolderKey).toString();
  if (!chosen.isEmpty()) return PathFrom(chosen);
  const QString documents = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
  return PathFrom(documents.isEmpty() ? QDir::homePath() : documents) / "Elbowroom";
}

void SetSessionsFolder(const std::filesystem::path& folder) {
  QSettings().setValue(kFolderKey, QString::fromStdString(folder.string()));
}

std::filesystem::path SessionPlace::Next() {
  if (!given_.empty()) return std::exchange(given_, {});
  const std::filesystem::path folder = SessionsFolder();
  core::MakeFolder(folder);
  const std::filesystem::path first = folder / DefaultSessionName(QDateTime::currentDateTime()).toStdString();
  std::filesystem::path path = first;
  // Two trials may begin in one second.
  for (int i = 2; std::filesystem::exists(path); ++i)
    path = folder / (first.stem().string() + "-" + std::to_string(i) + ".db");
  return path;
}

}  // namespace elbowroom::console
