// The pictures of a trial over time, as SVG.
#pragma once

#include <string>

#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// Parts as lanes, touches as bars shaded by depth, tools in use above, the spacings as step lines under them
// on the same time axis. Needs at least one frame.
[[nodiscard]] std::string TimelineChart(const ReportData& data);

// One spacing over the trial, its values written on, times in contact shaded, the estimate as a dashed line
// where it is the judged spacing. Needs at least one frame.
[[nodiscard]] std::string SpacingChart(const ReportData& data, const SpacingStudy& study);

}  // namespace elbowroom::sessions
