// What of a layout gives way or flows, as rows.
#pragma once

#include "core/layout.h"
#include "sessions/database.h"

namespace elbowroom::sessions {

// The layout is valid and its parts are rows already.
void InsertGivesWay(Database& database, const core::Layout& layout);

// Into a layout whose parts have been read. Throws: Error{kFormat} naming the file where a row is damaged.
void ReadGivesWay(Database& database, core::Layout* layout);

}  // namespace elbowroom::sessions
