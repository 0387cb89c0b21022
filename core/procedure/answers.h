// What the participant estimated and answered, as the events of a trial say it.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/session.h"

namespace elbowroom::core {

[[nodiscard]] std::string_view ToString(AskedWhen when);  // "before", "after"
[[nodiscard]] std::optional<AskedWhen> ParseAskedWhen(std::string_view text);

// The item of the trial's survey; nothing if it has none of that name.
[[nodiscard]] const SurveyItem* FindItem(const TrialInfo& trial, AskedWhen when, std::string_view item);

// The space that the participant says is needed. Nothing: none given.
struct Estimates {
  std::optional<double> before_mm;
  std::optional<double> after_mm;
};

// The last event of each kind holds; before the trial, without one, TrialInfo::estimate_mm.
[[nodiscard]] Estimates EstimatesOf(const TrialInfo& trial, std::span<const SessionEvent> events);

// One an item of the trial's survey, in its order. The last event holds; nothing: it wasn't answered.
[[nodiscard]] std::vector<std::optional<int>> AnswersOf(const TrialInfo& trial,
                                                        std::span<const SessionEvent> events);

}  // namespace elbowroom::core
