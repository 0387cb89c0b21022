// Events, episodes, near misses and heat maps as rows.
#pragma once

#include <vector>

#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// Both insert into the open transaction. A changed spacing is one of the layout's. Throws: Error{kDatabase}.
void InsertEvent(Database& database, const core::Layout& layout, const core::SessionEvent& event);
void InsertOutcome(Database& database, const core::SessionOutcome& outcome);

// All throw Error{kFormat} where a row is damaged or doesn't fit the layout.
// In the order of their frames; equal frames in the order in which they came.
[[nodiscard]] std::vector<core::SessionEvent> ReadEvents(Database& database);
// By id.
[[nodiscard]] std::vector<core::ContactEpisode> ReadEpisodes(Database& database, const core::Layout& layout);
[[nodiscard]] std::vector<core::NearMiss> ReadNearMisses(Database& database, const core::Layout& layout);
// By part; a value for each patch of its mesh.
[[nodiscard]] std::vector<core::HeatMap> ReadHeatMaps(Database& database, const core::Layout& layout);

}  // namespace elbowroom::sessions
