// Which touch or near miss of a replay is which of the session that was replayed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/findings/finding.h"
#include "core/layout.h"
#include "core/session.h"
#include "sessions/session_closing.h"

namespace elbowroom::control {

// Gives the findings of the outcome the ids of those of the origin that they are, and leaves the others
// without one.
//
// Two are the same if they are of one part (by name) and overlap in time. Where several do, the pair that
// agrees best comes first: of one kind, then with the smaller sum of the time (s) that they don't share and
// of the distance of their places on the part (in units of 100 mm); each has one partner. A touch may have
// been a near miss, or the other way.
void MatchFindings(std::span<const core::Finding> origin, const core::Layout& layout,
                   core::SessionOutcome* outcome);

// What was judged again.
struct CheckedRange {
  double begin_s = 0.0;  // of the first frame
  double end_s = 0.0;    // of the last one
};

// What the replay takes over: remarks of all findings of the origin; and those findings that aren't in the
// outcome, as gone where their part is in the layout and all of their time was judged again, else as not
// checked. A finding that is gone becomes resolved, unless people approved it; one that was resolved and is
// here becomes active. Both with a remark by `by`, at `at_utc`, that says so.
[[nodiscard]] sessions::SessionClosing TakeOverReview(std::span<const core::Finding> origin,
                                                      const core::Layout& layout, const CheckedRange& checked,
                                                      const core::SessionOutcome& outcome,
                                                      const std::string& by, const std::string& at_utc);

}  // namespace elbowroom::control
