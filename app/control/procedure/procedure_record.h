// What a running trial records of its procedure: which step is under way.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/procedure/step_runs.h"
#include "core/session.h"

namespace elbowroom::control {

// Thread: one.
class ProcedureRecord {
 public:
  explicit ProcedureRecord(std::vector<std::string> steps) : steps_(std::move(steps)) {}

  // Ends the step under way and begins `step`; empty: none. The events of that, with frame and time; a note
  // for a step that the trial doesn't have.
  [[nodiscard]] std::vector<core::SessionEvent> Begin(const std::string& step, core::FrameIndex frame,
                                                      double time_s);

  [[nodiscard]] const std::optional<core::StepRun>& under_way() const { return under_way_; }

 private:
  std::vector<std::string> steps_;
  std::optional<core::StepRun> under_way_;
};

// Whether the event is the participant's, of the trial as a whole: an estimate or an answer.
[[nodiscard]] bool IsOfParticipant(const core::EventContent& what);

}  // namespace elbowroom::control
