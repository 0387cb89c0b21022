// Whether two results of one frame are the same rows.
#pragma once

#include <cstdint>

#include "core/session.h"

namespace elbowroom::sessions {

struct RowComparison {
  std::int64_t rows = 0;  // of `recorded`: part_frame, contact, contact_point, clearance, part_motion
  bool are_equal = false;
};

// Compares what FrameInserter would write of the parts, value by value, doubles exactly. Silhouettes and
// stamps aren't compared. Held to the rows of two files by replay_test.
[[nodiscard]] RowComparison CompareRows(const core::FrameRecord& recorded, const core::FrameRecord& replayed);

}  // namespace elbowroom::sessions
