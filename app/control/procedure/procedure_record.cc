#include "app/control/procedure/procedure_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace elbowroom::control {

std::vector<core::SessionEvent> ProcedureRecord::Begin(const std::string& step, core::FrameIndex frame,
                                                       double time_s) {
  if (!step.empty() && std::ranges::find(steps_, step) == steps_.end())
    return {{frame, time_s, core::Note{fmt::format("no step is named '{}'", step)}}};
  std::vector<core::SessionEvent> events;
  if (under_way_) events.push_back({frame, time_s, core::StepMarked{under_way_->step, false}});
  under_way_.reset();
  if (step.empty()) return events;
  under_way_ = core::StepRun{step, frame, time_s};
  events.push_back({frame, time_s, core::StepMarked{step, true}});
  return events;
}

bool IsOfParticipant(const core::EventContent& what) {
  return std::holds_alternative<core::EstimateGiven>(what) ||
         std::holds_alternative<core::SurveyAnswered>(what) ||
         std::holds_alternative<core::QuestionnaireAnswered>(what);
}

}  // namespace elbowroom::control
