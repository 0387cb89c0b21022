// Records a trial into one SQLite file, frame by frame, without ever dropping one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/session.h"

namespace elbowroom::sessions {

// A thread of its own owns the database connection and commits what has come in. A program that dies leaves a
// session of status 'recording' with every committed frame; so does a writer destroyed without Finish().
//
// Append() and Finish() throw what went wrong on that thread (Error{kDatabase}: disk full, file locked) at
// the next call after it; from then on nothing more is recorded. Thread: any number may append; Finish(),
// Abandon() and the destructor come when no other call is under way.
class SessionWriter {
 public:
  // Creates the file. Throws: Error{kFile} when `path` exists or its folder doesn't or can't be written;
  // Error{kCamera} or Error{kRange} for a rig or layout that isn't valid. No file is left then.
  SessionWriter(const std::filesystem::path& path, core::SessionHeader header);
  ~SessionWriter();
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  // Waits where the disk is behind by a queue's length. The record fits the header: one silhouette of the
  // right size a camera (core::SoftMask::Validate), one value a spacing, one contact a part in the layout's
  // order; a frame comes once.
  void Append(core::FrameRecord record);
  // A changed spacing is one of the layout's.
  void Append(core::SessionEvent event);

  // Writes what is still queued and the outcome, marks the session 'complete' and folds it into a single
  // file.
  void Finish(const core::SessionOutcome& outcome);

  // Removes the file: for a trial that failed, so that nothing half-written stays.
  void Abandon();

  // That a crash of this program can't take away any more.
  [[nodiscard]] std::int64_t frames_committed() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace elbowroom::sessions
