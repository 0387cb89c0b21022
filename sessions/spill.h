// Frames that the session file couldn't take for a while: a session file of its own beside it, S.db.spill.
#pragma once

#include <filesystem>
#include <string>

#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// A new session file at the spill's path of `session`, with the same set-up. An episode in it may name frames
// of the session. Throws: what Database::Create throws.
// recording_id: the session's own.
[[nodiscard]] Database CreateSpill(const std::filesystem::path& session, const core::SessionHeader& header,
                                   const std::string& recording_id);

// Whether a spill lies beside the session: a file, not a link to one.
[[nodiscard]] bool HasSpill(const std::filesystem::path& session);

// Whether the spill holds frames of this session. False for a spill whose program was killed while making it.
// Throws: Error{kFile} naming it when it is another session's, or no session.
[[nodiscard]] bool IsOwnSpill(Database& session);

// Copies everything of the spill that the session doesn't have yet into the session, which is open to be
// written, and then removes the spill. A merge that was broken off can be repeated. Throws: DatabaseError;
// the spill stays then.
void MergeSpill(Database& session);

}  // namespace elbowroom::sessions
