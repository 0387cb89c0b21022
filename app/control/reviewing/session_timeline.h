// A session over time, as a value that can be drawn: touches and near misses a part, and what happened.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/control/reviewing/listed_findings.h"
#include "app/control/reviewing/reviewed_session.h"
#include "core/findings/finding.h"
#include "core/layout.h"
#include "core/session.h"

namespace elbowroom::control {

struct TimelineSpan {
  std::size_t finding = 0;  // its place in the list
  core::FindingKind kind = core::FindingKind::kTouch;
  double begin_s = 0.0;
  double end_s = 0.0;
};

struct TimelineRow {
  std::string part;
  std::vector<TimelineSpan> spans;  // by time
};

enum class MarkKind { kGap, kTool, kNote, kStep, kBookmark, kAnswer };  // an estimate is an answer, too

struct TimelineMark {
  MarkKind kind = MarkKind::kNote;
  double time_s = 0.0;
  std::string text;  // "payload_a_gap: 140 to 240 mm"
};

struct SessionTimeline {
  double begin_s = 0.0;             // of the first frame
  double end_s = 0.0;               // of the last one
  std::vector<TimelineRow> rows;    // the layout's parts, in its order
  std::vector<TimelineMark> marks;  // by time. Changes of a gap that follow each other within a second, such
                                    // as those of a dragged slider, are one
};

// Thread: any.
[[nodiscard]] SessionTimeline TimelineOf(const ReviewedSession& session,
                                         const std::vector<ListedFinding>& findings);

// What a what-if found, a row a part; the spans' places mean nothing.
[[nodiscard]] std::vector<TimelineRow> RowsOf(const core::Layout& layout,
                                              const core::SessionOutcome& outcome);

// The place in the list of the touch or near miss whose worst frame comes next after (`step` 1) or before
// (-1) that position. Those that aren't in the session don't count. Nothing: there is none.
[[nodiscard]] std::optional<std::size_t> NextFinding(const std::vector<ListedFinding>& findings,
                                                     std::size_t from_position, int step);

}  // namespace elbowroom::control
