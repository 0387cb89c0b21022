// Frames that the session file couldn't take for a while: a session file of its own beside it, S.db.spill.
#pragma once

#include <filesystem>

#include "core/session.h"
#include "sessions/database.h"

namespace elbowroom::sessions {

// A new session file at the spill's path of `session`, with the same set-up. An episode in it may name frames
// of the session. Throws: what Database::Create throws.
[[nodiscard]] Database CreateSpill(const std::filesystem::path& session, const core::SessionHeader& header);

// Whether a spill lies beside the session.
[[nodiscard]] bool HasSpill(const std::filesystem::path& session);

// Everything of its spill that the session, open to be written, doesn't have yet; then the spill is removed.
// May be broken off at any time and done again. Throws: DatabaseError; the spill stays then.
void MergeSpill(Database& session);

}  // namespace elbowroom::sessions
