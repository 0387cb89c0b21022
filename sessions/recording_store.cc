#include "sessions/recording_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/system/file_sync.h"
#include "core/system/utc_time.h"
#include "sessions/database/session_files.h"
#include "sessions/event_rows.h"
#include "sessions/finding_rows.h"
#include "sessions/header_rows.h"
#include "sessions/outcome_rows.h"
#include "sessions/schema/schema.h"
#include "sessions/spill.h"

namespace elbowroom::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRescuedSuffix = ".rescued";

Database CreateSession(const fs::path& path, const core::SessionHeader& header) {
  header.rig.Validate();
  header.layout.Validate();
  if (HasSpill(path)) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("'{}{}' is left from another session; move it away or choose another "
                                  "session path",
                                  path.string(), kSpillSuffix));
  }
  Database database = Database::Create(path);
  try {
    Transaction transaction(database);
    Migrate(database);
    InsertHeader(database, header);
    InsertRecordingId(database, MakeRecordingId(database));
    transaction.Commit();
    database.RememberPlace();
  } catch (...) {
    RemoveDatabaseFiles(path);
    throw;
  }
  return database;
}

fs::path RescuedName(const fs::path& name, int number) {
  const std::string which = number == 1 ? "" : std::to_string(number);
  return WithSuffix(name, fmt::format("{}{}", kRescuedSuffix, which));
}

// The path itself. Where something that is no folder has taken the name of one of its folders, a path below a
// folder with ".rescued" appended.
fs::path BelowFolders(const fs::path& path) {
  const auto is_taken = [](const fs::path& folder) {
    std::error_code failure;
    return fs::exists(fs::symlink_status(folder, failure)) && !fs::is_directory(folder, failure);
  };
  fs::path below;
  for (const fs::path& name : path.parent_path()) {
    const fs::path folder = below / name;
    below = folder;
    for (int number = 1; is_taken(below); ++number) below = RescuedName(folder, number);
  }
  return below / path.filename();
}

// Renames the complete database `part` to `target`. False where another file than that of `open` has that
// name.
bool PutInPlace(const fs::path& part, const fs::path& target, const Database& open) {
  const bool is_own = open.IsTheFile(target);
  std::error_code failure;
  if (!is_own && fs::exists(fs::symlink_status(target, failure))) return false;
  // SQLite would take the log of the database that is gone for the new one's.
  for (const std::string_view suffix : {kLogSuffix, kLogIndexSuffix, kRollbackSuffix})
    fs::remove(WithSuffix(target, suffix), failure);
  if (is_own || ::link(part.c_str(), target.c_str()) != 0) {
    if (!is_own && errno == EEXIST) return false;
    fs::rename(part, target, failure);
    if (failure) {
      throw core::Error(core::ErrorKind::kFile,
                        fmt::format("session '{}': it was removed and can't be made again: {}; make its "
                                    "folder writable",
                                    target.string(), failure.message()));
    }
  }
  fs::remove(part, failure);
  core::SyncFolder(core::FolderOf(target));
  return true;
}

}  // namespace

RecordingStore::RecordingStore(const fs::path& path, const core::SessionHeader& header)
    : header_(header), path_(path) {
  session_.emplace(CreateSession(path, header));
  recording_id_ = ReadRecordingId(session_->database).value();
}

void RecordingStore::Write(std::span<const RecordingEntry> entries) {
  Place& place = spill_ ? *spill_ : *session_;
  Transaction transaction(place.database);
  for (const RecordingEntry& entry : entries) WriteInto(place, entry);
  transaction.Commit();
  place.database.RememberPlace();
}

void RecordingStore::WriteInto(Place& place, const RecordingEntry& entry) const {
  if (const auto* record = std::get_if<core::FrameRecord>(&entry)) {
    place.frames->Insert(*record);
  } else if (const auto* event = std::get_if<core::SessionEvent>(&entry)) {
    InsertEvent(place.database, header_, *event);
  } else if (const auto* end = std::get_if<SessionEnd>(&entry)) {
    WriteEnd(place.database, *end);
  }
}

void RecordingStore::WriteEnd(Database& database, const SessionEnd& end) const {
  core::SessionOutcome outcome = end.outcome;
  NameFindings(header_.layout, header_.origin ? header_.origin->first_recording_id : recording_id_, &outcome);
  InsertOutcome(database, outcome);
  InsertAbsentFindings(database, end.closing.absent);
  for (const auto& [finding, remark] : end.closing.remarks) InsertRemark(database, finding, remark);
  InsertFootage(database, end.closing.footage);
  database.Execute(
      fmt::format("UPDATE session SET status = 'complete', ended_at_utc = '{}'", core::NowUtc()));
}

bool RecordingStore::RestoreIfGone() {
  std::optional<Place>& place = spill_ ? spill_ : session_;
  if (place->database.IsInPlace()) return false;
  Database again = MadeAgain();  // until then the old place stays as it is
  place.reset();
  place.emplace(std::move(again));
  if (!spill_) path_ = place->database.path();
  return true;
}

Database RecordingStore::MadeAgain() {
  Database& open = (spill_ ? spill_ : session_)->database;
  const fs::path name = BelowFolders(open.path());
  core::MakeFolder(core::FolderOf(name));
  // The copy is completed under a name of its own first: half a session must not have the session's name.
  const fs::path part = WithSuffix(name, ".part");
  RemoveDatabaseFiles(part);
  {
    Database copy = Database::CopyTo(part, open);
    copy.FoldLogIntoFile();
  }
  fs::path target = name;
  for (int number = 1; !PutInPlace(part, target, open); ++number) target = RescuedName(name, number);
  return Database::OpenToWrite(target);
}

void RecordingStore::SpillBeside() { spill_.emplace(CreateSpill(path_, header_, recording_id_)); }

void RecordingStore::ReturnFromSpill() {
  { const Transaction free_to_write(session_->database); }
  spill_.reset();  // closing its last connection folds its log
  try {
    MergeSpill(session_->database);
  } catch (...) {
    spill_.emplace(Database::OpenToWrite(WithSuffix(path_, kSpillSuffix)));
    spill_->database.Execute("PRAGMA foreign_keys = OFF");
    throw;
  }
}

void RecordingStore::Close() {
  for (std::optional<Place>* place : {&spill_, &session_}) {
    if (!*place) continue;
    (*place)->frames.reset();
    try {
      (*place)->database.FoldLogIntoFile();
    } catch (const core::Error&) {
      // The log stays beside the file: a reader finds everything in the two.
    }
    place->reset();
  }
}

bool RecordingStore::Remove() {
  spill_.reset();
  session_.reset();
  const bool is_spill_gone = RemoveDatabaseFiles(WithSuffix(path_, kSpillSuffix));
  return RemoveDatabaseFiles(path_) && is_spill_gone;
}

}  // namespace elbowroom::sessions
