// Where a recording goes: its session file, or a spill beside it while that file can't be written.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "core/session.h"
#include "sessions/database/database.h"
#include "sessions/frame_rows.h"
#include "sessions/session_closing.h"

namespace elbowroom::sessions {

struct SessionEnd {
  core::SessionOutcome outcome;
  SessionClosing closing;
};

// An entry of a recording. Entries come in order; the end is the last.
using RecordingEntry = std::variant<core::FrameRecord, core::SessionEvent, SessionEnd>;

// Thread: one.
class RecordingStore {
 public:
  // Creates the session; its set-up is on the disk afterwards. Throws: what Database::Create throws;
  // Error{kCamera} or Error{kRange} for a rig or layout that isn't valid. No file is left then.
  RecordingStore(const std::filesystem::path& path, const core::SessionHeader& header);

  // Writes all entries or none; they are on the disk afterwards. Throws: DatabaseError.
  void Write(std::span<const RecordingEntry> entries);

  // If the file that entries go to (session or spill), its log or their folder was removed or replaced: makes
  // it again from what this program still has open, and returns true. The name stays, but ".rescued" is
  // appended to the name of the file or of a folder that something else has taken. Throws: core::Error while
  // that can't be done; nothing is lost then.
  bool RestoreIfGone();

  // From here on entries go to a spill. Throws: core::Error.
  void SpillBeside();
  // Moves the spill into the session file, to which entries go again. Throws: DatabaseError.
  void ReturnFromSpill();
  [[nodiscard]] bool is_spilling() const { return spill_.has_value(); }

  // Folds the log into the file, unless other programs are reading it. Nothing is written afterwards.
  void Close();

  // Closes the connection and removes the files; true if nothing is left.
  bool Remove();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  // A database with its prepared statements.
  struct Place {
    explicit Place(Database opened) : database(std::move(opened)), frames(std::in_place, database) {}
    Database database;
    std::optional<FrameInserter> frames;
  };
  void WriteInto(Place& place, const RecordingEntry& entry) const;
  void WriteEnd(Database& database, const SessionEnd& end) const;
  [[nodiscard]] Database MadeAgain();

  const core::SessionHeader& header_;
  std::filesystem::path path_;
  std::string recording_id_;
  std::optional<Place> session_, spill_;
};

}  // namespace elbowroom::sessions
