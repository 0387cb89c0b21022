// What was set up for a session, as rows: trial, rig, layout, meshes, settings, versions.
#pragma once

#include "core/session.h"
#include "sessions/database.h"

namespace elbowroom::sessions {

// Into a fresh schema; the session's status is 'recording'. The header's rig and layout are valid.
// Throws: Error{kDatabase}.
void InsertHeader(Database& database, const core::SessionHeader& header);

// Throws: Error{kDatabase} or Error{kFormat} where the file is damaged or holds no session row.
[[nodiscard]] core::SessionHeader ReadHeader(Database& database);

}  // namespace elbowroom::sessions
