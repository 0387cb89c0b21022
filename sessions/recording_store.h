// Where a recording goes: its session file, or a spill beside it while that file can't be written.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "core/session.h"
#include "sessions/database.h"
#include "sessions/frame_rows.h"

namespace elbowroom::sessions {

// What a recording consists of, in the order in which it comes. An outcome is the last.
using RecordingEntry = std::variant<core::FrameRecord, core::SessionEvent, core::SessionOutcome>;

// Thread: one.
class RecordingStore {
 public:
  // Creates the session with its set-up, which is on the disk then. Throws: what Database::Create throws;
  // Error{kCamera} or Error{kRange} for a rig or layout that isn't valid. No file is left then.
  RecordingStore(const std::filesystem::path& path, const core::SessionHeader& header);

  // All or none; on the disk afterwards. Throws: DatabaseError.
  void Write(std::span<const RecordingEntry> entries);

  // Where the session file, its log or their folder have been removed or replaced: makes them again from what
  // this program still has open, under the same name, or, if another file bears that or its folder's, with
  // ".rescued" appended. True if so. Throws: core::Error while that can't be done; nothing is lost then.
  bool RestoreIfGone();

  // From here on entries go to a spill. Throws: core::Error.
  void SpillBeside();
  // Moves the spill into the session file, which takes the entries again. Throws: DatabaseError.
  void ReturnFromSpill();
  [[nodiscard]] bool is_spilling() const { return spill_.has_value(); }

  // One file, as far as others who read it let that be. Nothing is written afterwards.
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
  [[nodiscard]] Database MadeAgain();

  const core::SessionHeader& header_;
  std::filesystem::path path_;
  std::string recording_id_;
  std::optional<Place> session_, spill_;
};

}  // namespace elbowroom::sessions
