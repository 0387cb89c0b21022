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
#include "sessions/finding_rows.h"
#include "sessions/header_rows.h"
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

void RequireFinished(SoundSession& session) {
  Statement row(session.database(), "SELECT status FROM session");
  if (row.Next() && row.Text(0) == ToString(SessionStatus::kComplete)) return;
  const std::string path = session.database().path().string();
  throw core::Error(
      core::ErrorKind::kRange,
      session.is_in_use()
          ? fmt::format("session '{}' is being recorded; merge it when its trial has ended", path)
          : fmt::format("session '{}' was cut off and has no touches yet; 'elbowroom replay' makes a whole "
                        "one of it",
                        path));
}

MergedSession Describe(const std::filesystem::path& path, std::int64_t id, Database& session) {
  const core::SessionHeader header = ReadHeader(session);
  const std::string first = FirstRecordingId(session, header);
  return {id, path, header.trial.participant, ReadRecordingId(session).value_or(first), first, 0};
}

void RequireOther(const MergedSession& session, std::span<const MergedSession> taken) {
  const auto same = std::ranges::find(taken, session.recording_id, &MergedSession::recording_id);
  if (same != taken.end())
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("'{}' and '{}' are the same session; give each one once",
                                  same->file.string(), session.file.string()));
}

}  // namespace

std::vector<MergedSession> MergeSessions(std::span<const std::filesystem::path> sessions,
                                         const std::filesystem::path& merged, const core::Progress& progress,
                                         const std::stop_token& stop) {
  UnfinishedSession unfinished(merged);
  std::vector<MergedSession> taken;
  {
    MergedFile file(unfinished.temporary());
    const std::string now = core::NowUtc();
    for (const auto& path : sessions) {
      progress.Report(std::ssize(taken), std::ssize(sessions), "sessions merged");
      SoundSession source(path, stop);
      Transaction transaction(file.database());
      source.limit().Guarded([&] {
        source.database().Execute("BEGIN");  // all tables as they are at one moment
        RequireFinished(source);
        MergedSession session = Describe(path, std::ssize(taken) + 1, source.database());
        RequireOther(session, taken);
        file.AddSource(session, now, stop);
        for (const std::string& table : MergedTables())
          session.rows += file.Take(source.database(), table, session.session_id, progress, stop);
        taken.push_back(std::move(session));
      });
      transaction.Commit();
    }
    file.database().FoldLogIntoFile();
  }
  unfinished.PutInPlace();
  return taken;
}

}  // namespace elbowroom::sessions
