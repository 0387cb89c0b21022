#include "sessions/sound_session.h"

#include <fmt/format.h>

#include <utility>

#include "sessions/database/damage.h"
#include "sessions/integrity.h"
#include "sessions/schema/schema.h"
#include "sessions/schema/schema_check.h"

namespace elbowroom::sessions {
namespace {

// Checks the file before anything is read from it: first its tables, then its integrity. Rows are checked as
// they are read.
void RequireSound(Database& database, const std::stop_token& stop) {
  RequireReadableSession(database);
  const std::int64_t schema = database.ReadInteger("PRAGMA user_version");
  if (schema == 0) {  // without tables; reading the header then fails, as there is no set-up
    if (database.ReadInteger("SELECT count(*) FROM sqlite_schema") > 0)
      FailAsDamaged(fmt::format("session '{}'", database.path().string()), "it has tables, but of schema 0");
    return;
  }
  RequireTablesOfSchema(database, schema);
  RequireIntegrity(database, schema, stop);
}

Database CopyOfNewestSchema(Database& database, const std::stop_token& stop) {
  const std::int64_t schema = database.ReadInteger("PRAGMA user_version");
  Database copy = database.CopyInMemory(stop);
  DropAllButTablesOfSchema(copy, schema);
  Migrate(copy);
  return copy;
}

}  // namespace

SoundSession::SoundSession(const std::filesystem::path& path, const std::stop_token& stop)
    : opened_(OpenSession(path)), limit_(opened_.database, stop) {
  limit_.Guarded([&] { Check(stop); });
}

void SoundSession::Check(const std::stop_token& stop) {
  Database& database = opened_.database;
  DistrustFile(database);
  RequireSound(database, stop);
  schema_ = database.ReadInteger("PRAGMA user_version");
  if (schema_ == kSchemaVersion) return;
  Database copy = CopyOfNewestSchema(database, stop);
  limit_ = QueryLimit(copy, stop);
  database = std::move(copy);
  DistrustFile(database);
}

}  // namespace elbowroom::sessions
