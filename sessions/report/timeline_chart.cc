#include "sessions/report/timeline_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/procedure/event_text.h"
#include "core/procedure/step_runs.h"
#include "sessions/charts/ink.h"
#include "sessions/report/chart.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

constexpr std::size_t kLongestTitle = 60;
constexpr double kLaneHeight = 30.0;
constexpr double kToolShare = 0.3;  // of a lane's height
constexpr double kTouchShare = 0.62;

Chart ChartOverTime(const ReportData& data, std::string title) {
  Chart chart;
  chart.title = std::move(title);
  chart.x_name = "time, s";
  chart.x_from = data.columns.begin_s;
  chart.x_to = data.columns.end_s;
  chart.zooms = true;
  return chart;
}

// Equal neighbours are one bar.
void AddContacts(const ReportData& data, core::PartIndex part, std::size_t lane, ChartPanel* panel) {
  const std::vector<PartColumn>& columns = data.parts[part].columns;
  const double darkest_mm = DarkestDepth(data);
  for (std::size_t i = 0; i < columns.size();) {
    const std::size_t first = i;
    if (!columns[i++].deepest_mm) continue;
    const std::string color = DepthColour(*columns[first].deepest_mm / darkest_mm);
    while (i < columns.size() && columns[i].deepest_mm &&
           DepthColour(*columns[i].deepest_mm / darkest_mm) == color)
      ++i;
    panel->bars.push_back({.from = data.columns.BeginOf(first),
                           .to = data.columns.BeginOf(i),
                           .lane = lane,
                           .color = color,
                           .height = kTouchShare});
  }
}

std::string ToldOf(const ReportData& data, const ReportTouch& touch) {
  const std::string how = touch.is_near_miss
                              ? "at least " + Millimetres(touch.closest->interval.lower_mm) + " away"
                              : Millimetres(touch.depth_mm) + " deep";
  return fmt::format("{} on {}: {:.2f} s to {:.2f} s, {} at {:.2f} s", NameOf(touch),
                     data.header.layout.parts[touch.part].name, touch.begin_s, touch.end_s, how,
                     touch.time_s);
}

void AddFrames(const ReportData& data, std::size_t first_lane, ChartPanel* panel) {
  for (std::size_t i = 0; i < data.list.touches.size(); ++i) {
    const ReportTouch& touch = data.list.touches[i];
    panel->bars.push_back({.from = touch.begin_s,
                           .to = touch.end_s + data.frame_period_s,
                           .lane = first_lane + touch.part,
                           .color = ColorOf(touch.is_near_miss ? Ink::kCaution : Ink::kText),
                           .height = kTouchShare,
                           .is_frame = true,
                           .told = ToldOf(data, touch),
                           .touch = i});
  }
}

void AddTool(const ReportData& data, const std::string& tool, std::size_t lane, ChartPanel* panel) {
  bool is_in_use = false;
  for (const core::SessionEvent& event : data.events) {
    const auto* mark = std::get_if<core::ToolMarked>(&event.what);
    if (mark == nullptr || mark->tool != tool || mark->in_use == is_in_use) continue;
    is_in_use = mark->in_use;
    if (is_in_use)
      panel->bars.push_back(
          {.from = event.time_s, .to = data.end_s, .lane = lane, .color = "", .height = kToolShare});
    else
      panel->bars.back().to = event.time_s;
  }
}

// A lane for each step that was begun, in the order of the first begins.
void AddSteps(const ReportData& data, ChartPanel* panel) {
  for (const core::StepRun& run : core::StepRunsOf(data.events)) {
    const std::string name = "step: " + run.step;
    auto lane = static_cast<std::size_t>(std::ranges::find(panel->lanes, name) - panel->lanes.begin());
    if (lane == panel->lanes.size()) panel->lanes.push_back(name);
    const ChartBar bar{.from = run.begin_s,
                       .to = run.end_s.value_or(data.end_s),
                       .lane = lane,
                       .color = ColorOf(Ink::kSpacing),
                       .height = kToolShare};
    panel->bars.push_back(bar);
  }
}

// A narrow bar at each, on a lane of their own.
void AddBookmarks(const ReportData& data, ChartPanel* panel) {
  constexpr double kBookmarkShare = 0.003;  // of the chart's width
  const double width_s = kBookmarkShare * (data.columns.end_s - data.columns.begin_s);
  const std::size_t lane = panel->lanes.size();
  for (const core::SessionEvent& event : data.events) {
    if (!std::holds_alternative<core::Bookmark>(event.what)) continue;
    if (panel->lanes.size() == lane) panel->lanes.emplace_back("bookmarks");
    ChartBar bar{.from = event.time_s,
                 .to = event.time_s + width_s,
                 .lane = lane,
                 .color = ColorOf(Ink::kCaution),
                 .height = kTouchShare};
    panel->bars.push_back(bar);
    bar.is_frame = true;
    bar.told = fmt::format("{} at {:.2f} s", core::EventText(event.what), event.time_s);
    panel->bars.push_back(bar);
  }
}

ChartPanel LanePanel(const ReportData& data) {
  ChartPanel panel;
  AddSteps(data, &panel);
  AddBookmarks(data, &panel);
  for (const std::string& tool : ToolsMarked(data)) {
    AddTool(data, tool, panel.lanes.size(), &panel);
    panel.lanes.push_back(tool);
  }
  const std::size_t first_part = panel.lanes.size();
  for (core::PartIndex part = 0; part < data.parts.size(); ++part) {
    AddContacts(data, part, panel.lanes.size(), &panel);
    panel.lanes.push_back(data.header.layout.parts[part].name);
  }
  AddFrames(data, first_part, &panel);
  panel.height_px = std::max(kLaneHeight * static_cast<double>(panel.lanes.size()), kLaneHeight);
  return panel;
}

ChartPanel SpacingPanel(const ReportData& data, const SpacingStudy& study, double height_px) {
  ChartPanel panel;
  panel.title = Shortened(data.header.layout.spacings[study.spacing].name, kLongestTitle) + ", mm";
  panel.height_px = height_px;
  ChartLine line{.name = data.header.layout.spacings[study.spacing].name, .ink = Ink::kSpacing, .points = {}};
  line.is_stepped = true;
  for (const SpacingStep& step : study.steps) line.points.push_back({step.time_s, step.spacing_mm});
  if (!study.steps.empty()) line.points.push_back({data.end_s, study.steps.back().spacing_mm});
  panel.lines.push_back(std::move(line));
  double low = study.levels.front().spacing_mm, high = study.levels.back().spacing_mm;
  const double estimate_mm = data.header.trial.estimate_mm;
  if (estimate_mm > 0.0 && data.judged_spacing == study.spacing) {
    panel.levels.push_back({estimate_mm, "estimate " + Millimetres(estimate_mm), Ink::kCaution});
    low = std::min(low, estimate_mm);
    high = std::max(high, estimate_mm);
  }
  const double margin = std::max(0.2 * (high - low), 5.0);
  panel.low = std::floor(low - margin);
  panel.high = std::ceil(high + margin);
  return panel;
}

// Columns with any part in contact, joined.
std::vector<ChartSpan> ContactSpans(const ReportData& data) {
  std::vector<ChartSpan> spans;
  bool was_touched = false;
  for (std::size_t i = 0; i < data.columns.count; ++i) {
    const bool is_touched = std::ranges::any_of(
        data.parts, [&](const PartSummary& part) { return part.columns[i].deepest_mm.has_value(); });
    if (is_touched && !was_touched) spans.push_back({data.columns.BeginOf(i), 0.0});
    if (is_touched) spans.back().to = data.columns.BeginOf(i + 1);
    was_touched = is_touched;
  }
  return spans;
}

}  // namespace

double DarkestDepth(const ReportData& data) {
  if (!(data.deepest_mm > 0.0)) return 1.0;
  const double step = std::pow(10.0, std::floor(std::log10(data.deepest_mm)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (data.deepest_mm <= factor * step) return factor * step;
  }
  return 10.0 * step;
}

Chart TimelineChart(const ReportData& data) {
  Chart chart = ChartOverTime(data, "Touches of each part over time, and the spacings");
  chart.panels.push_back(LanePanel(data));
  for (const SpacingStudy& study : data.spacings) chart.panels.push_back(SpacingPanel(data, study, 80.0));
  return chart;
}

Chart SpacingChart(const ReportData& data, const SpacingStudy& study) {
  Chart chart =
      ChartOverTime(data, "Spacing " + data.header.layout.spacings[study.spacing].name + " over time");
  chart.panels.push_back(SpacingPanel(data, study, 180.0));
  chart.panels.back().spans = ContactSpans(data);
  return chart;
}

}  // namespace elbowroom::sessions
