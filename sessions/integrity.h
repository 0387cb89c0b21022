// Whether a session file is whole, before anything is read from it.
#pragma once

#include <cstdint>
#include <stop_token>

#include "sessions/database.h"

namespace elbowroom::sessions {

// Makes the connection one that only reads, in defensive mode, without memory-mapped pages, and with no value
// longer than the file. The schema stays trusted: its own CHECKs call JSON functions, which SQLite would
// leave out of its integrity check otherwise; RequireTablesOfSchema() has seen to it before.
void DistrustFile(Database& database);

// All of the file is looked at once: SQLite's own integrity check, references between rows, and that each
// frame has its spacings, silhouettes and parts. In one snapshot, so that a recording may go on meanwhile.
// The tables are those of `schema` (RequireTablesOfSchema).
// Throws: Error{kFormat} naming the first damage; Error{kFile} where there is no room for the temporary copy
// that this takes; Error{kCancelled}.
void RequireIntegrity(Database& database, std::int64_t schema, const std::stop_token& stop);

}  // namespace elbowroom::sessions
