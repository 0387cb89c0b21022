#include "app/control/outcome_tracker.h"

#include <utility>
#include <vector>

#include "app/control/recorded_frame.h"
#include "app/control/trial_rules.h"
#include "core/procedure/tools_in_use.h"
#include "core/progress.h"

namespace elbowroom::control {

OutcomeTracker::OutcomeTracker(const core::TrialInfo& trial, std::span<const core::TriangleTree> part_trees)
    : tracker_(TrackerOptionsOf(trial)), heat_(part_trees), told_(part_trees.size()) {}

void OutcomeTracker::Add(const FrameResult& frame, std::span<const std::string> tools_in_use) {
  heat_.Add(frame.record.time_s, frame.hull, frame.world_from_parts, frame.record.contacts);
  tracker_.Add({frame.record, frame.world_from_parts, tools_in_use});
}

void OutcomeTracker::TellHeat(HeatWatch* watch) {
  std::vector<core::HeatMap> maps;
  for (core::PartIndex i = 0; i < told_.size(); ++i)
    if (std::exchange(told_[i], heat_.changes(i)) != heat_.changes(i)) maps.push_back(heat_.MapOf(i));
  if (!maps.empty()) watch->Put(std::move(maps));
}

core::SessionOutcome OutcomeTracker::Outcome() const {
  return {tracker_.Episodes(), tracker_.NearMisses(), heat_.Maps()};
}

core::SessionOutcome OutcomeFromFrames(const sessions::SessionReader& session, const core::Progress& progress,
                                       const std::stop_token& stop) {
  std::vector<core::TriangleTree> part_trees;
  for (const core::Part& part : session.header().layout.parts) part_trees.emplace_back(part.mesh);
  OutcomeTracker tracker(session.header().trial, part_trees);
  const std::vector<sessions::FrameSummary> frames = session.frames();
  core::ToolsOfFrames tools(session.events());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    core::ThrowIfStopped(stop, "putting the session's touches together");
    tracker.Add(*RebuildFrame(session, frames[i].frame), tools.At(frames[i].frame));
    progress.Report(static_cast<std::int64_t>(i + 1), static_cast<std::int64_t>(frames.size()),
                    "touches of a session that wasn't ended, frame");
  }
  return tracker.Outcome();
}

sessions::SessionReader OpenWithOutcome(const std::filesystem::path& session, const core::Progress& progress,
                                        const std::stop_token& stop) {
  sessions::SessionReader reader(session, stop);
  reader.Freeze();
  if (!reader.has_outcome()) reader.AdoptOutcome(OutcomeFromFrames(reader, progress, stop));
  return reader;
}

}  // namespace elbowroom::control
