#include "sessions/schema.h"

#include <fmt/format.h>

#include <array>

#include "core/error.h"

namespace elbowroom::sessions {
namespace {

using core::Error;
using core::ErrorKind;

// Entry i leads from schema i to schema i + 1. An entry that has been released never changes.
using Migration = std::string (*)();
constexpr std::array<Migration, kSchemaVersion> kMigrations = {&Schema1Sql, &Schema2Sql, &Schema3Sql,
                                                               &Schema4Sql, &Schema5Sql, &Schema6Sql};

}  // namespace

void Migrate(Database& database) {
  const std::int64_t found = database.ReadInteger("PRAGMA user_version");
  core::Require(found >= 0 && found <= kSchemaVersion,
                "the database's schema is one that this program knows");
  for (auto i = static_cast<std::size_t>(found); i < kMigrations.size(); ++i)
    database.Execute(kMigrations[i]());
  database.Execute(
      fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplicationId, kSchemaVersion));
}

void RequireReadableSession(Database& database) {
  const std::string path = database.path().string();
  if (database.ReadInteger("PRAGMA application_id") != kApplicationId) {
    throw Error(ErrorKind::kFormat, fmt::format("'{}' is not an elbowroom session; check the path", path));
  }
  const std::int64_t found = database.ReadInteger("PRAGMA user_version");
  if (found > kSchemaVersion) {
    throw Error(ErrorKind::kFormat,
                fmt::format("session '{}' has schema {}, this program knows schemas up to {}; open it "
                            "with a newer elbowroom",
                            path, found, kSchemaVersion));
  }
}

}  // namespace elbowroom::sessions
