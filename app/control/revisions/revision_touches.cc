#include "app/control/revisions/revision_touches.h"

#include <algorithm>
#include <span>
#include <string>

namespace elbowroom::control {
namespace {

RevisionTouch TouchAt(const review::StudyStep& step, std::span<const core::PartIndex> parts) {
  RevisionTouch touch;
  for (const core::PartIndex part : parts) {
    touch.frames_in_contact = std::max(touch.frames_in_contact, step.parts[part].frames_in_contact);
    touch.deepest_mm = std::max(touch.deepest_mm, step.parts[part].deepest_mm);
  }
  return touch;
}

// The recorded layout's parts of the names of those that the revision changes.
std::vector<core::PartIndex> PartsBefore(const SpacingSweep& sweep, const SweptRevision& revision) {
  std::vector<core::PartIndex> parts;
  for (const core::PartIndex part : revision.changed) {
    const auto before = std::ranges::find(sweep.parts, revision.parts[part]);
    if (before != sweep.parts.end())
      parts.push_back(static_cast<core::PartIndex>(before - sweep.parts.begin()));
  }
  return parts;
}

}  // namespace

std::vector<RevisionTouches> TouchesOfRevisions(const SpacingSweep& sweep) {
  const std::size_t steps = sweep.all.all.steps.size();
  std::vector<RevisionTouches> revisions;
  for (std::size_t k = 0; k < sweep.revisions.size(); ++k) {
    const SweptRevision& revision = sweep.revisions[k];
    const std::vector<core::PartIndex> before = PartsBefore(sweep, revision);
    RevisionTouches touches{{}, std::vector<std::size_t>(steps), std::vector<std::size_t>(steps)};
    for (const SweptSession& session : sweep.sessions) {
      std::vector<RevisionTouch> of_session;
      for (std::size_t step = 0; step < steps; ++step) {
        of_session.push_back(TouchAt(session.of_revisions[k].all.steps[step], revision.changed));
        if (of_session.back().frames_in_contact > 0) ++touches.touching[step];
        if (TouchAt(session.curves.all.steps[step], before).frames_in_contact > 0)
          ++touches.touching_before[step];
      }
      touches.by_session.push_back(std::move(of_session));
    }
    revisions.push_back(std::move(touches));
  }
  return revisions;
}

std::vector<double> StepsOf(const SpacingSweep& sweep) {
  std::vector<double> steps_mm;
  for (const review::StudyStep& step : sweep.all.all.steps) steps_mm.push_back(step.spacing_mm);
  return steps_mm;
}

}  // namespace elbowroom::control
