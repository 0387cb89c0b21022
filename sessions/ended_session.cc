#include "sessions/ended_session.h"

#include <fmt/format.h>

#include "core/error.h"
#include "sessions/schema/schema.h"
#include "sessions/session_opening.h"

namespace elbowroom::sessions {

void AddToSession(const std::filesystem::path& session, std::string_view until_then,
                  const std::function<void(Database&)>& add) {
  // Puts right what a crash left, before the file is opened to be written.
  const bool is_in_use = OpenSession(session).is_in_use;
  Database database = Database::OpenToWrite(session);
  RequireReadableSession(database);
  if (is_in_use && database.ReadInteger("SELECT count(*) FROM session WHERE status = 'recording'") > 0)
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("session '{}' is being recorded; {} when the trial has ended",
                                  session.string(), until_then));
  {
    Transaction transaction(database);
    Migrate(database);
    add(database);
    transaction.Commit();
  }
  database.FoldLogIntoFile();
}

}  // namespace elbowroom::sessions
