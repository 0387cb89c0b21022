// Records a trial into one SQLite file, frame by frame, without ever dropping one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/session.h"
#include "sessions/session_closing.h"

namespace elbowroom::sessions {

// Where recorded frames go at the moment.
enum class RecordingState {
  kInFile,    // into the session file
  kInMemory,  // kept until the file can be written again
  kInSpill,   // into S.db.spill beside it, which is merged as soon as the session file can be written, or is
              // opened
};

struct RecordingNews {
  RecordingState state = RecordingState::kInFile;
  // One line for the experimenter: what is wrong, or that it is well again. Empty at the beginning.
  std::string line;
};

struct SessionWriterOptions {
  // Called on the writer's thread whenever the state changes; must not block.
  std::function<void(const RecordingNews&)> on_news;
  // How long Append() and Finish() wait for a file that can't be written, once no more is kept in memory or
  // the trial has ended, s.
  double patience_s = 10.0;
  // Frames kept in memory at most while the file can't be written; also at most 256 MB.
  std::int64_t most_held_frames = 1800;
  // How long the file can't be written before frames go into a spill, s.
  double spill_after_s = 1.0;
};

// A thread of its own owns the database connection. While the file can be written, the first frame is
// committed at once and each later one within 0.1 s. A committed frame is on the disk, whatever happens to
// the program or the machine. A program that dies leaves a session of status 'recording' with every committed
// frame; so does a writer destroyed without Finish().
//
// While the file can't be written (another program holds it locked, the disk is full, the file or its folder
// was removed) frames stay in memory, or go into a spill, and the writer tries again. Only when that takes
// longer than the options allow do Append() and Finish() throw what is wrong (Error{kDatabase},
// Error{kFile}); from then on nothing more is recorded, and what was committed stays. Thread: any number may
// append; Finish(), Abandon() and the destructor come when no other call is under way.
class SessionWriter {
 public:
  // Creates the file with its set-up, on the disk. Throws: Error{kFile} when `path` exists or its folder
  // doesn't or can't be written; Error{kCamera} or Error{kRange} for a rig or layout that isn't valid. No
  // file is left then.
  SessionWriter(const std::filesystem::path& path, core::SessionHeader header,
                SessionWriterOptions options = {});
  ~SessionWriter();
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  // Waits while the queue to the disk is full. The record fits the header: one silhouette of the right size a
  // camera (core::SoftMask::Validate), one value a spacing, one contact a part in the layout's order; a frame
  // comes once.
  void Append(core::FrameRecord record);
  // What it names (spacing, step, item of the survey) is of the header.
  void Append(core::SessionEvent event);

  // Writes what is still queued, the outcome and the closing, names the findings that have no id, marks the
  // session 'complete' and folds it into a single file. Where the session file still can't be written, a
  // spill with the rest stays beside it. If it throws, what was committed stays, and a session without a
  // frame is removed.
  void Finish(core::SessionOutcome outcome, SessionClosing closing = {});

  // Removes a session that has no frame. Throws: Error{kFile} when the file can't be removed.
  void Abandon();

  // Frames that neither a crash of this program nor a power failure can take away any more.
  [[nodiscard]] std::int64_t frames_committed() const;

  [[nodiscard]] RecordingState state() const;

  // The session file: as given, or what it is called after it was removed and another one took its name.
  [[nodiscard]] std::filesystem::path path() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::sessions
