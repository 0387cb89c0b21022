// Events and episodes as rows.
#pragma once

#include <span>
#include <vector>

#include "core/session.h"
#include "sessions/database.h"

namespace elbowroom::sessions {

// Into the open transaction. A changed spacing is one of `layout`'s. Throws: Error{kDatabase}.
void InsertEvent(Database& database, const core::Layout& layout, const core::SessionEvent& event);
void InsertEpisodes(Database& database, std::span<const core::ContactEpisode> episodes);

// In the order of their frames; equal frames in the order in which they came.
[[nodiscard]] std::vector<core::SessionEvent> ReadEvents(Database& database);
[[nodiscard]] std::vector<core::ContactEpisode> ReadEpisodes(Database& database);  // by id

}  // namespace elbowroom::sessions
