#include "sessions/report/approach_chart.h"

#include <algorithm>
#include <vector>

#include "sessions/report/chart.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

constexpr std::size_t kLongestName = 60;

// In the layout's order.
std::vector<const PartSummary*> ClosestParts(const ReportData& data) {
  std::vector<const PartSummary*> parts;
  for (const PartSummary& part : data.parts)
    if (part.closest) parts.push_back(&part);
  std::ranges::stable_sort(parts, {}, [](const PartSummary* part) { return part->closest->upper_mm; });
  if (parts.size() > kMostApproaches) parts.resize(kMostApproaches);
  std::ranges::sort(parts, {}, [](const PartSummary* part) { return part->frames.part; });
  return parts;
}

ChartPanel PanelOf(const ReportData& data, const PartSummary& part) {
  ChartPanel panel;
  panel.title = Shortened(data.header.layout.parts[part.frames.part].name, kLongestName) + ", mm to the hull";
  panel.low = 0.0;
  ChartBand band{.name = "at least, at most", .ink = Ink::kSpacing, .intervals = {}};
  for (std::size_t i = 0; i < part.columns.size(); ++i) {
    const PartColumn& column = part.columns[i];
    // To the column's end, so that one alone has a width.
    for (const double x : {data.columns.BeginOf(i), data.columns.BeginOf(i + 1)})
      band.intervals.push_back({x, column.closest_lower_mm, column.closest_upper_mm});
  }
  panel.bands.push_back(std::move(band));
  if (const double required_mm = data.header.trial.required_clearance_mm; required_mm > 0.0)
    panel.levels.push_back({required_mm, "required " + Millimetres(required_mm), Ink::kCaution});
  return panel;
}

}  // namespace

Chart ApproachChart(const ReportData& data) {
  Chart chart;
  chart.title = "Distance of parts to the hull over time";
  chart.x_name = "time, s";
  chart.x_from = data.columns.begin_s;
  chart.x_to = data.columns.end_s;
  chart.zooms = true;
  for (const PartSummary* part : ClosestParts(data)) chart.panels.push_back(PanelOf(data, *part));
  return chart;
}

}  // namespace elbowroom::sessions
