// The charts of a trial over time.
#pragma once

#include "sessions/charts/chart.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// Tools in use and parts as lanes, contacts as bars shaded by depth, touches and near misses as frames around
// them, the spacings as step lines below. Needs at least one frame.
[[nodiscard]] Chart TimelineChart(const ReportData& data);

// One spacing over the trial, times in contact shaded, the estimate as a dashed line where it is the judged
// spacing. Needs at least one frame.
[[nodiscard]] Chart SpacingChart(const ReportData& data, const SpacingStudy& study);

// The depth in mm that the darkest colour stands for: a round number at or above the deepest.
[[nodiscard]] double DarkestDepth(const ReportData& data);

}  // namespace elbowroom::sessions
