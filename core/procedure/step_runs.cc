#include "core/procedure/step_runs.h"

#include <algorithm>
#include <variant>

namespace elbowroom::core {

std::optional<double> StepRun::duration_s() const {
  return end_s ? std::optional(*end_s - begin_s) : std::nullopt;
}

std::vector<StepRun> StepRunsOf(std::span<const SessionEvent> events) {
  std::vector<StepRun> runs;
  for (const SessionEvent& event : events) {
    const auto* mark = std::get_if<StepMarked>(&event.what);
    if (mark == nullptr) continue;
    const auto under_way = std::ranges::find_if(
        runs, [&](const StepRun& run) { return run.step == mark->step && !run.end_frame; });
    if (mark->begun && under_way == runs.end()) runs.push_back({mark->step, event.frame, event.time_s});
    if (mark->begun || under_way == runs.end()) continue;
    under_way->end_frame = event.frame;
    under_way->end_s = event.time_s;
  }
  return runs;
}

}  // namespace elbowroom::core
