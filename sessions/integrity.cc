#include "sessions/integrity.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "sessions/database/damage.h"
#include "sessions/database/query_limit.h"
#include "sessions/database/statement.h"
#include "sessions/schema/schema_check.h"

namespace elbowroom::sessions {
namespace {

// A value can't be longer than its file. A small file gets this limit, which the schema's own SQL needs.
constexpr std::int64_t kLongestValueOfSmallFile = 1 << 20;
constexpr std::int64_t kLongestValue = 1'000'000'000;  // SQLite's own limit

void Set(sqlite3* connection, int setting, int value) {
  sqlite3_db_config(connection, setting, value, nullptr);
}

std::string NameOf(const Database& database) { return fmt::format("session '{}'", database.path().string()); }

// While it lives, all reads see one state of the file.
class ReadSnapshot {
 public:
  explicit ReadSnapshot(Database& database) : database_(database) { database_.Execute("BEGIN"); }
  ~ReadSnapshot() { database_.connection().tryExec("COMMIT"); }
  ReadSnapshot(const ReadSnapshot&) = delete;
  ReadSnapshot& operator=(const ReadSnapshot&) = delete;

 private:
  Database& database_;
};

void RequireOk(Database& database, const std::string& pragma) {
  Statement check(database, pragma);
  const std::string verdict = check.Next() ? check.Text(0) : "no answer";
  if (verdict == "ok") return;
  // "*** in database main ***" and a line break come before what is wrong with pages.
  const std::size_t line = verdict.find('\n');
  FailAsDamaged(NameOf(database),
                fmt::format("the integrity check says '{}'",
                            Quotable(line == std::string::npos ? verdict : verdict.substr(line + 1))));
}

void RequireReferences(Database& database, std::int64_t schema) {
  for (const std::string& table : TablesOfSchema(schema)) {
    Statement check(database, fmt::format("PRAGMA foreign_key_check({})", table));
    if (check.Next())
      FailAsDamaged(NameOf(database), fmt::format("a row of '{}' refers to one of '{}' that isn't there",
                                                  table, Quotable(check.Text(2))));
  }
}

// References and primary keys have been checked: the rows of the frames are complete if their number is
// right.
void RequireWholeFrames(Database& database) {
  const std::int64_t frames = database.ReadInteger("SELECT count(*) FROM frame");
  for (const auto& [table, of_each] : {std::pair{"frame_spacing", "spacing"},
                                       std::pair{"silhouette", "camera"}, std::pair{"part_frame", "part"}}) {
    const std::int64_t rows = database.ReadInteger(fmt::format("SELECT count(*) FROM {}", table));
    const std::int64_t things = database.ReadInteger(fmt::format("SELECT count(*) FROM {}", of_each));
    if (rows == frames * things) continue;
    FailAsDamaged(NameOf(database),
                  fmt::format("rows are missing: table '{}' has {}, where {} frames of {} belong", table,
                              rows, frames, things));
  }
}

// A frame has stamps of all cameras or of none; schemas before 8 have no stamps at all.
void RequireWholeStamps(Database& database) {
  Statement row(database,
                "SELECT frame_index, count(*) FROM camera_stamp GROUP BY frame_index "
                "HAVING count(*) <> (SELECT count(*) FROM camera)");
  if (row.Next())
    FailAsDamaged(NameOf(database), fmt::format("rows are missing: frame {} has {} rows in table "
                                                "'camera_stamp', where it has one a camera, or none",
                                                row.Integer(0), row.Integer(1)));
}

// A connection that can't write has no CHECKs (SQLite's sqlite3AddCheckConstraint). So the check of the rows
// asks one that SQLite takes for able to write, of the file where it may be written, else of a copy.
Database WithChecks(Database& database, const std::stop_token& stop) {
  std::optional<Database> beside = database.OpenBeside();
  if (!beside) return database.CopyAside(stop);
  DistrustFile(*beside);
  return std::move(*beside);
}

}  // namespace

void DistrustFile(Database& database) {
  sqlite3* connection = database.connection().getHandle();
  Set(connection, SQLITE_DBCONFIG_DEFENSIVE, 1);
  Set(connection, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0);
  Set(connection, SQLITE_DBCONFIG_ENABLE_FTS3_TOKENIZER, 0);
  Set(connection, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0);
  database.Execute("PRAGMA mmap_size = 0; PRAGMA cell_size_check = ON; PRAGMA query_only = ON");
  const std::int64_t file_bytes =
      database.ReadInteger("PRAGMA page_count") * database.ReadInteger("PRAGMA page_size");
  sqlite3_limit(connection, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::clamp(file_bytes, kLongestValueOfSmallFile, kLongestValue)));
  sqlite3_limit(connection, SQLITE_LIMIT_ATTACHED, 0);
  // No schema of ours has a LIKE, and one pattern can take for ever within a single step.
  sqlite3_limit(connection, SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 1);
  sqlite3_limit(connection, SQLITE_LIMIT_WORKER_THREADS, 0);
}

void RequireIntegrity(Database& database, std::int64_t schema, const std::stop_token& stop) {
  const ReadSnapshot snapshot(database);
  Database beside = WithChecks(database, stop);
  const QueryLimit limit(beside, stop);
  std::future<void> relations = std::async(std::launch::async, [&] {
    RequireReferences(database, schema);
    RequireWholeFrames(database);
    if (schema >= 8) RequireWholeStamps(database);
  });
  limit.Guarded([&] { RequireOk(beside, "PRAGMA integrity_check(1)"); });
  relations.get();  // after it: damaged pages are named first
}

}  // namespace elbowroom::sessions
