#include "sessions/session_opening.h"

#include <memory>

#include "sessions/database/private_copy.h"
#include "sessions/database/session_files.h"
#include "sessions/schema/schema.h"
#include "sessions/schema/schema_check.h"
#include "sessions/spill.h"

namespace elbowroom::sessions {
namespace {

// Whether frames of this session may lie in a spill. A complete session has all of its frames itself.
bool MayHaveSpilled(Database& session) {
  if (session.ReadInteger("PRAGMA user_version") == 0) return false;
  RequireReadableSession(session);
  RequireTablesOfSchema(session, session.ReadInteger("PRAGMA user_version"));
  return session.ReadInteger("SELECT count(*) FROM session WHERE status = 'recording'") > 0 &&
         IsOwnSpill(session);
}

void MergeSpillOf(const std::filesystem::path& path) {
  Database session = Database::OpenToWrite(path);
  MergeSpill(session);
  session.FoldLogIntoFile();
}

}  // namespace

OpenedSession OpenSession(const std::filesystem::path& path) {
  const bool is_in_use = IsInUse(path);
  {
    Database session = Database::OpenReadOnly(path);
    if (is_in_use || !HasSpill(path) || !MayHaveSpilled(session)) return {std::move(session), is_in_use};
  }
  try {
    MergeSpillOf(path);
    return {Database::OpenReadOnly(path), false};
  } catch (const DatabaseError&) {
    // The files are locked or can't be written. Neither holds for the copy below.
  }
  auto copy = std::make_shared<const PrivateCopy>(path);
  // Another reader may have merged the spill meanwhile.
  if (HasSpill(copy->path())) MergeSpillOf(copy->path());
  return {Database::OpenReadOnly(std::move(copy)), false};
}

}  // namespace elbowroom::sessions
