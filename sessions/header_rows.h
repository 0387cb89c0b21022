// What was set up for a session, as rows: trial, rig, layout, meshes, settings, versions.
#pragma once

#include <optional>
#include <string>

#include "core/session.h"
#include "sessions/database.h"

namespace elbowroom::sessions {

// Into a fresh schema; the session's status is 'recording'. The header's rig and layout are valid.
// Throws: Error{kDatabase}.
void InsertHeader(Database& database, const core::SessionHeader& header);

// Throws: Error{kDatabase} or Error{kFormat} where the file is damaged or holds no session row.
[[nodiscard]] core::SessionHeader ReadHeader(Database& database);

// What tells the recordings of two trials apart, and joins a spill with its session: random, kept beside the
// settings. Nothing: of an older program.
[[nodiscard]] std::string MakeRecordingId(Database& database);
void InsertRecordingId(Database& database, const std::string& id);
[[nodiscard]] std::optional<std::string> ReadRecordingId(Database& database);

}  // namespace elbowroom::sessions
