#include "sessions/schema/schema.h"

#include <fmt/format.h>

#include <array>

#include "core/error.h"
#include "sessions/database/damage.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;

// Entry i leads from schema i to schema i + 1. An entry that has been released never changes.
using Migration = std::string (*)();
constexpr std::array<Migration, kSchemaVersion> kMigrations = {
    &Schema1Sql, &Schema2Sql, &Schema3Sql, &Schema4Sql,  &Schema5Sql, &Schema6Sql,
    &Schema7Sql, &Schema8Sql, &Schema9Sql, &Schema10Sql, &Schema11Sql};

}  // namespace

void Migrate(Database& database) { MigrateTo(database, kSchemaVersion); }

void MigrateTo(Database& database, std::int64_t schema) {
  const std::int64_t found = database.ReadInteger("PRAGMA user_version");
  core::Require(found >= 0 && found <= schema && schema <= kSchemaVersion,
                "the database's schema is one that this program knows");
  for (auto i = static_cast<std::size_t>(found); i < static_cast<std::size_t>(schema); ++i)
    database.Execute(kMigrations[i]());
  database.Execute(
      fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplicationId, schema));
}

void RequireReadableSession(Database& database) {
  const std::string path = database.path().string();
  const std::int64_t application = database.ReadInteger("PRAGMA application_id");
  if (application == kMergedApplicationId)
    throw Error(
        ErrorKind::kFormat,
        fmt::format("'{}' holds several sessions ('sessions merge'), without their pictures; give one "
                    "of the sessions themselves, which its table 'source' names",
                    path));
  if (application != kApplicationId) {
    // What a recording's file holds before its log is folded in for the first time.
    if (database.ReadInteger("PRAGMA page_count") == 1 &&
        database.ReadInteger("SELECT count(*) FROM sqlite_schema") == 0) {
      throw Error(ErrorKind::kFormat,
                  fmt::format("'{}' is an empty database; of a session that was cut off, its '-wal' file is "
                              "needed, too: copy both",
                              path));
    }
    throw Error(ErrorKind::kFormat, fmt::format("'{}' is not an elbowroom session; check the path", path));
  }
  const std::int64_t found = database.ReadInteger("PRAGMA user_version");
  if (found < 0) FailAsDamaged(fmt::format("session '{}'", path), fmt::format("it has schema {}", found));
  if (found > kSchemaVersion) {
    throw Error(ErrorKind::kFormat,
                fmt::format("session '{}' has schema {}, this program knows schemas up to {}; open it "
                            "with a newer elbowroom",
                            path, found, kSchemaVersion));
  }
}

}  // namespace elbowroom::sessions
