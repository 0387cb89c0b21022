#include "core/procedure/answers.h"

#include <algorithm>
#include <variant>

namespace elbowroom::core {

std::string_view ToString(AskedWhen when) {
  switch (when) {
    case AskedWhen::kBefore:
      return "before";
    case AskedWhen::kAfter:
      return "after";
  }
  return "";
}

std::optional<AskedWhen> ParseAskedWhen(std::string_view text) {
  for (const AskedWhen when : {AskedWhen::kBefore, AskedWhen::kAfter})
    if (text == ToString(when)) return when;
  return std::nullopt;
}

const SurveyItem* FindItem(const TrialInfo& trial, AskedWhen when, std::string_view item) {
  const auto at = std::ranges::find_if(
      trial.survey, [&](const SurveyItem& other) { return other.when == when && other.item == item; });
  return at == trial.survey.end() ? nullptr : &*at;
}

Estimates EstimatesOf(const TrialInfo& trial, std::span<const SessionEvent> events) {
  Estimates estimates;
  if (trial.estimate_mm > 0.0) estimates.before_mm = trial.estimate_mm;
  for (const SessionEvent& event : events) {
    const auto* given = std::get_if<EstimateGiven>(&event.what);
    if (given == nullptr) continue;
    (given->when == AskedWhen::kBefore ? estimates.before_mm : estimates.after_mm) = given->estimate_mm;
  }
  return estimates;
}

std::vector<std::optional<int>> AnswersOf(const TrialInfo& trial, std::span<const SessionEvent> events) {
  std::vector<std::optional<int>> answers(trial.survey.size());
  for (const SessionEvent& event : events) {
    const auto* answered = std::get_if<SurveyAnswered>(&event.what);
    if (answered == nullptr) continue;
    const SurveyItem* item = FindItem(trial, answered->when, answered->item);
    if (item != nullptr) answers[static_cast<std::size_t>(item - trial.survey.data())] = answered->answer;
  }
  return answers;
}

}  // namespace elbowroom::core
