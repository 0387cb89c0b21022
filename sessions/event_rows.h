// A session's events as rows.
#pragma once

#include <vector>

#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// What it names (spacing, step, item of the survey) is of the session's set-up. Throws: PreconditionError.
void RequireOfSetUp(const core::EventContent& what, const core::SessionHeader& header);

// Inserts into the open transaction. Throws: Error{kDatabase}; what RequireOfSetUp throws.
void InsertEvent(Database& database, const core::SessionHeader& header, const core::SessionEvent& event);

// In the order of their frames; equal frames in the order in which they came. Throws: Error{kFormat} where a
// row is damaged.
[[nodiscard]] std::vector<core::SessionEvent> ReadEvents(Database& database);

}  // namespace elbowroom::sessions
