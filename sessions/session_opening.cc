#include "sessions/session_opening.h"

#include <memory>

#include "sessions/private_copy.h"
#include "sessions/schema.h"
#include "sessions/schema_check.h"
#include "sessions/session_files.h"
#include "sessions/spill.h"

namespace elbowroom::sessions {
namespace {

// A file that isn't what this program writes must not change one that is.
void RequireTablesOfASession(const std::filesystem::path& path) {
  Database database = Database::OpenReadOnly(path);
  RequireReadableSession(database);
  RequireTablesOfSchema(database, database.ReadInteger("PRAGMA user_version"));
}

// A program that was killed while it made the spill leaves one without tables.
bool HasTables(const std::filesystem::path& spill) {
  return Database::OpenReadOnly(spill).ReadInteger("SELECT count(*) FROM sqlite_schema") > 0;
}

void MergeSpillOf(const std::filesystem::path& path) {
  const std::filesystem::path spill = WithSuffix(path, kSpillSuffix);
  if (!HasTables(spill)) return;
  RequireTablesOfASession(path);
  RequireTablesOfASession(spill);
  Database session = Database::OpenToWrite(path);
  MergeSpill(session);
  session.FoldLogIntoFile();
}

}  // namespace

OpenedSession OpenSession(const std::filesystem::path& path) {
  const bool is_in_use = IsInUse(path);
  if (is_in_use || !HasSpill(path) || !std::filesystem::is_regular_file(path))
    return {Database::OpenReadOnly(path), is_in_use};
  try {
    MergeSpillOf(path);
    return {Database::OpenReadOnly(path), false};
  } catch (const DatabaseError&) {
    // Locked, or not to be written: the copy is neither.
  }
  auto copy = std::make_shared<const PrivateCopy>(path);
  // Another reader may have joined the two meanwhile.
  if (HasSpill(copy->path())) MergeSpillOf(copy->path());
  return {Database::OpenReadOnly(std::move(copy)), false};
}

}  // namespace elbowroom::sessions
