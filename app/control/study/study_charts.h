// What a study's report draws.
#pragma once

#include <vector>

#include "app/control/study/study.h"
#include "sessions/charts/chart.h"

namespace elbowroom::control {

// A lane for each participant, over mm: a bar from the estimate before the trial to what was needed, and
// marks for the estimates, and for what was needed without and with tools. No panel where no participant has
// any.
[[nodiscard]] sessions::Chart EstimateChart(const Study& study);

// Over the gap: how often the moved part that is touched most was touched, in per cent of a participant's
// frames, from the least to the greatest of the participants with the median; and at how many participants'
// motion nothing was touched at that gap and at all larger ones.
[[nodiscard]] sessions::Chart NeedChart(const Study& study);

// For each measure that several conditions have: the conditions' means with their intervals, and each
// participant. The one with the smallest decisive_p first; at most kMostConditionCharts.
inline constexpr std::size_t kMostConditionCharts = 8;
[[nodiscard]] std::vector<sessions::Chart> ConditionCharts(const Study& study);

}  // namespace elbowroom::control
