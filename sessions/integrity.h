// Whether a session file is whole, before anything is read from it.
#pragma once

#include <cstdint>
#include <stop_token>

#include "sessions/database/database.h"

namespace elbowroom::sessions {

// Makes the connection read-only, in defensive mode and without memory-mapped pages. A value may be as long
// as the file, or 1 MiB in a smaller file. The schema stays trusted: its CHECKs call JSON functions, and
// SQLite would leave such CHECKs of an untrusted schema out of its integrity check. RequireTablesOfSchema()
// checks the schema before that.
void DistrustFile(Database& database);

// Checks the whole file at once: SQLite's own integrity check, references between rows, and that each frame
// has its spacings, silhouettes and parts. Each check reads one state of the file, so that a recording may go
// on meanwhile. The tables are those of `schema` (RequireTablesOfSchema). Throws: Error{kFormat} naming the
// first damage; Error{kFile} where the file can't be written and there is no room for the temporary copy that
// this then takes; Error{kCancelled}.
void RequireIntegrity(Database& database, std::int64_t schema, const std::stop_token& stop);

}  // namespace elbowroom::sessions
