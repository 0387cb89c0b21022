// Episodes, near misses and heat maps as rows.
#pragma once

#include <vector>

#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// Inserts into the open transaction. Throws: Error{kDatabase}.
void InsertOutcome(Database& database, const core::SessionOutcome& outcome);

// All throw Error{kFormat} where a row is damaged or doesn't fit the layout.
// By id.
[[nodiscard]] std::vector<core::ContactEpisode> ReadEpisodes(Database& database, const core::Layout& layout);
[[nodiscard]] std::vector<core::NearMiss> ReadNearMisses(Database& database, const core::Layout& layout);
// By part; a value for each patch of its mesh.
[[nodiscard]] std::vector<core::HeatMap> ReadHeatMaps(Database& database, const core::Layout& layout);

}  // namespace elbowroom::sessions
