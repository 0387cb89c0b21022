// Touches and near misses as reviewers follow them, as rows.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/findings/finding.h"
#include "core/session.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// Gives an id to each episode and near miss that has none. No two get the same.
void NameFindings(const core::Layout& layout, const std::string& first_recording_id,
                  core::SessionOutcome* outcome);

// All three insert into the open transaction. Throws: Error{kDatabase}.
// Of the origin's findings those that aren't here.
void InsertAbsentFindings(Database& database, std::span<const core::Finding> findings);
void InsertRemark(Database& database, const core::FindingId& finding, const core::ReviewRemark& remark);
void InsertFootage(Database& database, std::span<const core::FootageFile> files);

// The findings of the outcome, then those of the origin that aren't here, each with its remarks; by time.
// Throws: Error{kFormat} where a row is damaged.
[[nodiscard]] std::vector<core::Finding> ReadFindings(Database& database, const core::Layout& layout,
                                                      const core::SessionOutcome& outcome);
[[nodiscard]] std::vector<core::FootageFile> ReadFootage(Database& database);

// The id of the session that cameras or footage gave, from which this one was replayed, at once or through
// other replays. Its own id where it was recorded itself.
[[nodiscard]] std::string FirstRecordingId(Database& database, const core::SessionHeader& header);

}  // namespace elbowroom::sessions
