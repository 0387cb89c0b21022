// A session's touches, near misses and heat maps, put together frame by frame.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "app/control/frame_result.h"
#include "app/control/layers/heat_watch.h"
#include "core/bvh.h"
#include "core/progress.h"
#include "core/session.h"
#include "review/contact_heat.h"
#include "review/contact_tracker.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

// Fed every frame in order of time. Thread: one.
class OutcomeTracker {
 public:
  // One tree a part, which must outlive this.
  OutcomeTracker(const core::TrialInfo& trial, std::span<const core::TriangleTree> part_trees);

  // tools_in_use: in order of name.
  void Add(const FrameResult& frame, std::span<const std::string> tools_in_use);

  [[nodiscard]] core::SessionOutcome Outcome() const;

  // Hands over the heat maps that have changed since the last call.
  void TellHeat(HeatWatch* watch);

 private:
  review::ContactTracker tracker_;
  review::ContactHeat heat_;
  std::vector<std::int64_t> told_;  // one a part: its changes that TellHeat has handed over
};

// The outcome of a session that was cut off: the same, row for row, as if its trial had been stopped after
// the last frame on the disk (outcome_tracker_test). Throws: what SessionReader throws; Error{kCancelled}.
[[nodiscard]] core::SessionOutcome OutcomeFromFrames(const sessions::SessionReader& session,
                                                     const core::Progress& progress,
                                                     const std::stop_token& stop);

// Opens a session for a report, as it is now. One that was cut off, or is still being recorded, gets the
// outcome of its frames so far, in memory only. Throws: what SessionReader and OutcomeFromFrames throw.
[[nodiscard]] sessions::SessionReader OpenWithOutcome(const std::filesystem::path& session,
                                                      const core::Progress& progress,
                                                      const std::stop_token& stop);

}  // namespace elbowroom::control
