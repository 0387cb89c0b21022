// What a session's end writes beside the outcome.
#pragma once

#include <utility>
#include <vector>

#include "core/findings/finding.h"
#include "core/session.h"

namespace elbowroom::sessions {

// All empty: a session that was recorded from cameras that keep no footage.
struct SessionClosing {
  std::vector<core::Finding> absent;  // of the origin's findings those that aren't here
  std::vector<std::pair<core::FindingId, core::ReviewRemark>>
      remarks;                             // in the order in which they were made
  std::vector<core::FootageFile> footage;  // RIG.yml first
};

}  // namespace elbowroom::sessions
