// A session's set-up as rows: trial, rig, layout, meshes, settings, versions.
#pragma once

#include <optional>
#include <string>

#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// The tables are empty; the session's status becomes 'recording'. The header's rig and layout are valid.
// Throws: Error{kDatabase}.
void InsertHeader(Database& database, const core::SessionHeader& header);

// Throws: Error{kDatabase} or Error{kFormat} where the file is damaged or holds no session row.
[[nodiscard]] core::SessionHeader ReadHeader(Database& database);

// A random id, kept beside the settings. It tells the recordings of two trials apart, and shows which session
// a spill belongs to. ReadRecordingId returns nothing for the session of an older program.
[[nodiscard]] std::string MakeRecordingId(Database& database);
void InsertRecordingId(Database& database, const std::string& id);
[[nodiscard]] std::optional<std::string> ReadRecordingId(Database& database);

}  // namespace elbowroom::sessions
