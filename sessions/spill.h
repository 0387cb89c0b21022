// Frames that the session file couldn't take for a while: a session file of its own beside it, S.db.spill.
#pragma once

#include <filesystem>
#include <string>

#include "core/session.h"
#include "sessions/database.h"

namespace elbowroom::sessions {

// A new session file at the spill's path of `session`, with the same set-up. An episode in it may name frames
// of the session. Throws: what Database::Create throws.
// recording_id: the session's own.
[[nodiscard]] Database CreateSpill(const std::filesystem::path& session, const core::SessionHeader& header,
                                   const std::string& recording_id);

// Whether a spill lies beside the session: a file, not a link to one.
[[nodiscard]] bool HasSpill(const std::filesystem::path& session);

// Whether what lies there holds frames of this session. False where a program was killed while it made it.
// Throws: Error{kFile} naming it when it is another session's, or no session.
[[nodiscard]] bool IsOwnSpill(Database& session);

// Everything of its spill that the session, open to be written, doesn't have yet; then the spill is removed.
// May be broken off at any time and done again. Throws: DatabaseError; the spill stays then.
void MergeSpill(Database& session);

}  // namespace elbowroom::sessions
