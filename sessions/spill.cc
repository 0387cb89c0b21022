#include "sessions/spill.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"
#include "sessions/database/session_files.h"
#include "sessions/database/statement.h"
#include "sessions/header_rows.h"
#include "sessions/schema/schema.h"
#include "sessions/schema/schema_check.h"

namespace elbowroom::sessions {
namespace {

// OR IGNORE: rows that are there already come from a merge that was broken off before it removed the spill. A
// mask has different numbers in the two files, so that masks are matched by their hashes.
constexpr const char* kMergeSql = R"sql(
INSERT OR IGNORE INTO main.frame SELECT * FROM spill.frame;
INSERT OR IGNORE INTO main.frame_spacing SELECT * FROM spill.frame_spacing;
INSERT OR IGNORE INTO main.mask (content_hash, width_px, height_px, object_px, words_zstd, levels_zstd)
  SELECT content_hash, width_px, height_px, object_px, words_zstd, levels_zstd FROM spill.mask;
INSERT OR IGNORE INTO main.silhouette
  SELECT s.frame_index, s.camera_index, ours.mask_id FROM spill.silhouette s
  JOIN spill.mask theirs USING (mask_id) JOIN main.mask ours ON ours.content_hash = theirs.content_hash;
INSERT OR IGNORE INTO main.camera_stamp SELECT * FROM spill.camera_stamp;
INSERT OR IGNORE INTO main.part_frame SELECT * FROM spill.part_frame;
INSERT OR IGNORE INTO main.contact SELECT * FROM spill.contact;
INSERT OR IGNORE INTO main.contact_point SELECT * FROM spill.contact_point;
INSERT OR IGNORE INTO main.clearance SELECT * FROM spill.clearance;
INSERT OR IGNORE INTO main.part_motion SELECT * FROM spill.part_motion;
INSERT OR IGNORE INTO main.episode SELECT * FROM spill.episode;
INSERT OR IGNORE INTO main.episode_spacing SELECT * FROM spill.episode_spacing;
INSERT OR IGNORE INTO main.near_miss SELECT * FROM spill.near_miss;
INSERT OR IGNORE INTO main.heat_map SELECT * FROM spill.heat_map;
INSERT INTO main.event (frame_index, time_s, kind, spacing_index, from_mm, to_mm, tool, in_use, note, step_index,
    begun, bookmark, asked, estimate_mm, item_index, answer, question_index, answer_number, answer_text)
  SELECT frame_index, time_s, kind, spacing_index, from_mm, to_mm, tool, in_use, note, step_index,
    begun, bookmark, asked, estimate_mm, item_index, answer, question_index, answer_number, answer_text
  FROM spill.event AS new
  WHERE NOT EXISTS (
    SELECT 1 FROM main.event AS old WHERE old.frame_index = new.frame_index AND old.time_s = new.time_s
      AND old.kind = new.kind AND old.spacing_index IS new.spacing_index AND old.from_mm IS new.from_mm
      AND old.to_mm IS new.to_mm AND old.tool IS new.tool AND old.in_use IS new.in_use AND old.note IS new.note
      AND old.step_index IS new.step_index AND old.begun IS new.begun AND old.bookmark IS new.bookmark
      AND old.asked IS new.asked AND old.estimate_mm IS new.estimate_mm AND old.item_index IS new.item_index
      AND old.answer IS new.answer AND old.question_index IS new.question_index
      AND old.answer_number IS new.answer_number AND old.answer_text IS new.answer_text)
  ORDER BY event_id;
INSERT OR IGNORE INTO main.absent_finding SELECT * FROM spill.absent_finding;
INSERT OR IGNORE INTO main.remark SELECT * FROM spill.remark;
INSERT OR IGNORE INTO main.footage SELECT * FROM spill.footage;
UPDATE main.session SET status = spill.session.status, ended_at_utc = spill.session.ended_at_utc
  FROM spill.session WHERE main.session.status = 'recording';
)sql";

}  // namespace

Database CreateSpill(const std::filesystem::path& session, const core::SessionHeader& header,
                     const std::string& recording_id) {
  Database spill = Database::Create(WithSuffix(session, kSpillSuffix));
  try {
    spill.Execute("PRAGMA foreign_keys = OFF");
    Transaction transaction(spill);
    Migrate(spill);
    InsertHeader(spill, header);
    InsertRecordingId(spill, recording_id);
    transaction.Commit();
    spill.RememberPlace();
    return spill;
  } catch (...) {
    RemoveDatabaseFiles(spill.path());
    throw;
  }
}

bool HasSpill(const std::filesystem::path& session) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(
      std::filesystem::symlink_status(WithSuffix(session, kSpillSuffix), ignored));
}

bool IsOwnSpill(Database& session) {
  const std::filesystem::path path = WithSuffix(session.path(), kSpillSuffix);
  const auto fail = [&](const char* what) {
    throw core::Error(
        core::ErrorKind::kFile,
        fmt::format("'{}' {}, but lies beside a session that was cut off; move it away, then try "
                    "again",
                    path.string(), what));
  };
  constexpr std::string_view kSqlite("SQLite format 3\0", 16);
  std::string start(kSqlite.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (file.gcount() == 0) return false;
  if (start != kSqlite) fail("is no session");
  try {
    Database spill = Database::OpenReadOnly(path);
    if (spill.ReadInteger("SELECT count(*) FROM sqlite_schema") == 0) return false;
    RequireReadableSession(spill);
    RequireTablesOfSchema(spill, spill.ReadInteger("PRAGMA user_version"));
    const auto id = ReadRecordingId(session), id_of_spill = ReadRecordingId(spill);
    if (!id || id != id_of_spill) fail("is another session's");
  } catch (const core::Error& error) {
    if (error.kind() == core::ErrorKind::kFile) throw;
    fail("is no whole session");
  }
  return true;
}

void MergeSpill(Database& session) {
  const std::filesystem::path spill = WithSuffix(session.path(), kSpillSuffix);
  Statement(session, "ATTACH ? AS spill").With(std::filesystem::absolute(spill).string()).Run();
  try {
    Transaction transaction(session);
    session.Execute(kMergeSql);
    transaction.Commit();
  } catch (...) {
    session.connection().tryExec("DETACH spill");
    throw;
  }
  session.Execute("DETACH spill");
  RemoveDatabaseFiles(spill);
}

}  // namespace elbowroom::sessions
