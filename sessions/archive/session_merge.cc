#include "sessions/archive/session_merge.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/error.h"
#include "core/system/file_hash.h"
#include "core/system/utc_time.h"
#include "sessions/archive/table_rows.h"
#include "sessions/database/database.h"
#include "sessions/database/statement.h"
#include "sessions/schema/schema.h"
#include "sessions/session_reader.h"
#include "sessions/sound_session.h"
#include "sessions/unfinished_session.h"

namespace elbowroom::sessions {
namespace {

// What takes the room, and is of no use without the rest of its session.
bool StaysInSession(std::string_view table) {
  constexpr std::array<std::string_view, 4> kStays = {"mesh", "mask", "silhouette", "v_silhouette"};
  return std::ranges::find(kStays, table) != kStays.end();
}

std::vector<std::string> MergedTables() {
  std::vector<std::string> tables = TablesAndViews();
  std::erase_if(tables, StaysInSession);
  return tables;
}

constexpr const char* kSourceTable = R"sql(
CREATE TABLE source (
  session_id INTEGER PRIMARY KEY,
  file TEXT NOT NULL,                 -- as it was given
  content_hash BLOB NOT NULL,         -- 128-bit XXH3 of the file
  recording_id TEXT NOT NULL,
  first_recording_id TEXT NOT NULL,   -- another one for a replay
  merged_at_utc TEXT NOT NULL
) STRICT;
)sql";

class MergedFile {
 public:
  explicit MergedFile(const std::filesystem::path& path) : database_(Database::Create(path)) {
    database_.Execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                                  kMergedApplicationId, kSchemaVersion));
    database_.Execute(kSourceTable);
  }

  void AddSource(const MergedSession& session, const std::string& at_utc, const std::stop_token& stop) {
    const auto hash = core::HashOfFile(session.file, stop);
    Statement(database_, "INSERT INTO source VALUES (?, ?, ?, ?, ?, ?)")
        .With(session.session_id, session.file.string(), std::span<const std::byte>(hash),
              session.recording_id, session.first_recording_id, at_utc)
        .Run();
  }

  // All rows of the session's table; its number of rows.
  std::int64_t Take(Database& session, const std::string& table, std::int64_t session_id,
                    const core::Progress& progress, const std::stop_token& stop) {
    MakeTable(session, table);
    const std::size_t columns = ColumnsOf(session, table).size();
    std::string places = "?";
    for (std::size_t i = 0; i < columns; ++i) places += ", ?";
    RawStatement insert(database_, fmt::format("INSERT INTO \"{}\" VALUES ({})", table, places));
    std::int64_t rows = 0;
    VisitRows(session, table, [&](sqlite3_stmt* row) {
      insert.Reset();
      sqlite3_bind_int64(insert.get(), 1, session_id);
      for (int i = 0; i < static_cast<int>(columns); ++i)
        sqlite3_bind_value(insert.get(), i + 2, sqlite3_column_value(row, i));
      (void)insert.Next();
      if (++rows % kRowsAReport != 0) return;
      core::ThrowIfStopped(stop, "the merge");
      progress.Report(rows, 0, fmt::format("session {}: rows of {}", session_id, table));
    });
    return rows;
  }

  Database& database() { return database_; }

 private:
  void MakeTable(Database& session, const std::string& table) {
    if (database_.connection().tableExists(table)) return;
    std::string columns = "session_id INTEGER NOT NULL REFERENCES source (session_id)";
    const std::vector<std::string> names = ColumnsOf(session, table);
    for (const std::string& name : names) columns += fmt::format(", \"{}\"", name);
    database_.Execute(fmt::format("CREATE TABLE \"{}\" ({})", table, columns));
    const bool has_frames = std::ranges::find(names, "frame_index") != names.end();
    database_.Execute(fmt::format("CREATE INDEX \"{}_by_session\" ON \"{}\" (session_id{})", table, table,
                                  has_frames ? ", frame_index" : ""));
  }

  Database database_;
};

void RequireFinished(const SessionReader& session) {
  if (session.has_outcome()) return;
  const std::string path = session.path().string();
  throw core::Error(
      core::ErrorKind::kRange,
      session.status() == SessionStatus::kRecording
          ? fmt::format("session '{}' is being recorded; merge it when its trial has ended", path)
          : fmt::format("session '{}' was cut off and has no touches yet; 'elbowroom replay' makes a whole "
                        "one of it",
                        path));
}

MergedSession Describe(const std::filesystem::path& path, std::int64_t id, const std::stop_token& stop) {
  const SessionReader session(path, stop);
  RequireFinished(session);
  return {id, path, session.header().trial.participant, session.recording_id(), session.first_recording_id(),
          0};
}

void RequireDifferent(std::span<const MergedSession> sessions) {
  for (std::size_t i = 0; i < sessions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (sessions[i].recording_id == sessions[j].recording_id)
        throw core::Error(core::ErrorKind::kRange,
                          fmt::format("'{}' and '{}' are the same session; give each one once",
                                      sessions[j].file.string(), sessions[i].file.string()));
}

}  // namespace

std::vector<MergedSession> MergeSessions(std::span<const std::filesystem::path> sessions,
                                         const std::filesystem::path& merged, const core::Progress& progress,
                                         const std::stop_token& stop) {
  UnfinishedSession unfinished(merged);
  std::vector<MergedSession> taken;
  for (const auto& path : sessions) {
    taken.push_back(Describe(path, std::ssize(taken) + 1, stop));
    progress.Report(std::ssize(taken), std::ssize(sessions), "opening sessions");
  }
  RequireDifferent(taken);
  {
    MergedFile file(unfinished.temporary());
    const std::string now = core::NowUtc();
    for (MergedSession& session : taken) {
      SoundSession source(session.file, stop);
      Transaction transaction(file.database());
      file.AddSource(session, now, stop);
      source.limit().Guarded([&] {
        source.database().Execute("BEGIN");
        for (const std::string& table : MergedTables())
          session.rows += file.Take(source.database(), table, session.session_id, progress, stop);
      });
      transaction.Commit();
    }
    file.database().FoldLogIntoFile();
  }
  unfinished.PutInPlace();
  return taken;
}

}  // namespace elbowroom::sessions
