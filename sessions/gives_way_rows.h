// The cloths, pushed parts and streams of a layout, as rows.
#pragma once

#include "core/layout.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// The layout is valid, and its parts have been inserted already.
void InsertGivesWay(Database& database, const core::Layout& layout);

// Reads into a layout whose parts have been read. Throws: Error{kFormat} naming the file where a row is
// damaged.
void ReadGivesWay(Database& database, core::Layout* layout);

}  // namespace elbowroom::sessions
