// Where the next trial's session is recorded.
#pragma once

#include <QDateTime>
#include <QString>
#include <filesystem>

namespace elbowroom::console {

// "elbowroom-20250131-093000.db" at local time.
[[nodiscard]] QString DefaultSessionName(const QDateTime& at);

// The folder that the user chose for sessions, else "Elbowroom" in the user's documents.
[[nodiscard]] std::filesystem::path SessionsFolder();
void SetSessionsFolder(const std::filesystem::path& folder);

// Nobody is asked: a participant may be waiting. Thread: UI.
class SessionPlace {
 public:
  // `given`: of the first trial; empty: it is as the others.
  explicit SessionPlace(std::filesystem::path given) : given_(std::move(given)) {}

  // The path given beforehand, once; else a new file in SessionsFolder(), which is made where it isn't there.
  // Throws: core::Error{kFile} where that can't be.
  [[nodiscard]] std::filesystem::path Next();

 private:
  std::filesystem::path given_;  // empty: none, or used up
};

}  // namespace elbowroom::console
