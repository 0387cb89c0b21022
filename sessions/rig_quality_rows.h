// How exact the rig is, as a row.
#pragma once

#include "core/rig.h"
#include "core/rig_quality.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// No row where nothing is known.
void InsertRigQuality(Database& database, const core::RigQuality& quality);

// Throws: Error{kFormat} naming the file where the row is damaged, or its covariance isn't that of the rig's
// cameras.
[[nodiscard]] core::RigQuality ReadRigQuality(Database& database, const core::Rig& rig);

}  // namespace elbowroom::sessions
