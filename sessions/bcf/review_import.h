// What a BCF file that came back says of a session's touches and near misses.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/findings/finding.h"
#include "sessions/bcf/bcf_topic.h"
#include "sessions/review_editor.h"

namespace elbowroom::sessions {

// "Approved" for kApproved, as BCF files have it.
[[nodiscard]] std::string TopicStatusOf(core::ReviewStatus status);

struct ReviewImport {
  std::vector<FindingRemark> remarks;  // new to the session, by time
  std::int64_t topics = 0;             // that are findings of the session
  std::int64_t of_others = 0;          // that aren't
  std::vector<std::string> notes;      // a line each: what wasn't taken, and why
};

// Takes over comments that the session doesn't have yet, with their authors and times, and statuses that
// differ from the session's and were set after the last remark on the finding; a status that isn't ours is
// taken for the nearest one where its meaning is common ("Open", "In Progress", "Closed", ...), else noted.
// Importing a file twice changes nothing the second time.
[[nodiscard]] ReviewImport RemarksFrom(std::span<const BcfTopic> topics,
                                       std::span<const core::Finding> findings);

}  // namespace elbowroom::sessions
