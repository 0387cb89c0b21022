// A spacing's step line, drawn into a plot.
#pragma once

#include <string>

#include "sessions/report/chart.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// `plot` with a value range that shows every step of the spacing, and the participant's estimate where this
// is the judged spacing.
[[nodiscard]] Plot FittedTo(Plot plot, const ReportData& data, const SpacingStudy& study);

// SVG: the line, its values where there is room, and the estimate.
[[nodiscard]] std::string SpacingLine(const Plot& plot, const ReportData& data, const SpacingStudy& study);

}  // namespace elbowroom::sessions
