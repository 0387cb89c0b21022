// Which recorded motions touch which revision of the CAD.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"

namespace elbowroom::control {

// A session's motion against the parts that a revision changes, at one gap.
struct RevisionTouch {
  std::int64_t frames_in_contact = 0;  // of the changed part that is touched in most of them
  double deepest_mm = 0.0;             // of all changed parts; certified lower bound
};

// A revision, held against all sessions.
struct RevisionTouches {
  std::vector<std::vector<RevisionTouch>> by_session;  // of each session, at each step
  std::vector<std::size_t> touching;                   // at each step: sessions whose motion touches it
  std::vector<std::size_t> touching_before;            // likewise the recorded parts of those names
};

// One a revision, in the sweep's order. A revision that changes no part is touched by none.
[[nodiscard]] std::vector<RevisionTouches> TouchesOfRevisions(const SpacingSweep& sweep);

// The steps' values, mm.
[[nodiscard]] std::vector<double> StepsOf(const SpacingSweep& sweep);

}  // namespace elbowroom::control
