// How close parts and hull came over time.
#pragma once

#include "sessions/charts/chart.h"
#include "sessions/report/report_data.h"

namespace elbowroom::sessions {

// The parts that came closest, most of them as panels; the others are in clearance.csv.
inline constexpr std::size_t kMostApproaches = 8;

// For each of these parts the bounds of its distance to the hull, the closest of each column (0 while they
// touch), with the required clearance as a dashed line. Needs a clearance (ReportData::has_clearance).
[[nodiscard]] Chart ApproachChart(const ReportData& data);

}  // namespace elbowroom::sessions
