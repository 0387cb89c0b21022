#include "sessions/review_editor.h"

#include <fmt/format.h>

#include "core/error.h"
#include "sessions/database/database.h"
#include "sessions/finding_rows.h"
#include "sessions/schema/schema.h"
#include "sessions/session_opening.h"

namespace elbowroom::sessions {

void AddRemarks(const std::filesystem::path& session, std::span<const FindingRemark> remarks) {
  // Puts right what a crash left, before the file is opened to be written.
  const bool is_in_use = OpenSession(session).is_in_use;
  Database database = Database::OpenToWrite(session);
  RequireReadableSession(database);
  if (is_in_use && database.ReadInteger("SELECT count(*) FROM session WHERE status = 'recording'") > 0)
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("session '{}' is being recorded; its touches can be reviewed when the trial has ended",
                    session.string()));
  {
    Transaction transaction(database);
    Migrate(database);
    for (const FindingRemark& said : remarks) InsertRemark(database, said.finding, said.remark);
    transaction.Commit();
  }
  database.FoldLogIntoFile();
}

}  // namespace elbowroom::sessions
