// Several sessions in one file, to ask questions across participants.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"

namespace elbowroom::sessions {

struct MergedSession {
  std::int64_t session_id = 0;  // in the merged file, from 1 on, in the order given
  std::filesystem::path file;
  std::string participant;
  std::string recording_id;
  std::string first_recording_id;
  std::int64_t rows = 0;  // that were taken over
};

// Writes `merged`, an SQLite file with the rows of all tables and views of the newest schema, under their
// names, each with a column session_id before its own; and the table `source`: which file each session came
// from, with its checksum. Meshes and pictures (tables mesh, mask, silhouette, v_silhouette) stay in the
// sessions, which are needed for replays and reports (docs/session_database.md). The file appears whole or
// not at all. Throws: Error{kFile}: `merged` exists, or can't be written; Error{kRange}: a session is given
// twice, or has no outcome yet; what SessionReader throws when it opens a file; Error{kCancelled}.
[[nodiscard]] std::vector<MergedSession> MergeSessions(std::span<const std::filesystem::path> sessions,
                                                       const std::filesystem::path& merged,
                                                       const core::Progress& progress,
                                                       const std::stop_token& stop);

}  // namespace elbowroom::sessions
