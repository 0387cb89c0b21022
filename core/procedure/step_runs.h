// When the steps of a trial's procedure were under way, as its events say it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/session.h"

namespace elbowroom::core {

// A step from its begin to its end. One that is begun again has another run.
struct StepRun {
  std::string step;
  FrameIndex begin_frame = 0;
  double begin_s = 0.0;
  std::optional<FrameIndex> end_frame = {};  // nothing: under way when the events end
  std::optional<double> end_s = {};

  [[nodiscard]] std::optional<double> duration_s() const;

  [[nodiscard]] bool operator==(const StepRun&) const = default;
};

// In the order in which they began. `events`: by frame, then as they came. An end of what hasn't begun, and
// a begin of what is under way, change nothing.
[[nodiscard]] std::vector<StepRun> StepRunsOf(std::span<const SessionEvent> events);

}  // namespace elbowroom::core
