#include "sessions/report/pair_course.h"

#include <algorithm>
#include <utility>

#include "core/pairs_of_rule.h"
#include "sessions/report/chart.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

constexpr std::size_t kLongestPartName = 40;  // of each of the two parts

void AddFrame(const ReportData& data, std::size_t frame, const PairSetting& setting,
              const PairApproaches& approaches, PairCourse* course) {
  const PairDistance& distance = setting.distances[course->pair];
  const double begin_s = data.frames[frame].time_s;
  const double end_s = EndOf(data, frame);
  if (course->closest == nullptr || distance.least_mm() < course->closest_distance().least_mm()) {
    course->closest = &setting;
    course->time_s = begin_s;
  }
  if (core::BreaksPairRule(distance.verdict, approaches.pairs[course->pair].authorised_contact))
    course->broken_s += end_s - begin_s;
  const ColumnRange range = data.columns.Of(begin_s, end_s);
  for (std::size_t i = range.first; i < range.end; ++i) {
    std::optional<PairDistance>& column = course->columns[i];
    if (!column || distance.least_mm() < column->least_mm()) column = distance;
  }
}

// How far the pair stayed from breaking its rule.
double Margin_mm(const PairApproaches& approaches, const PairCourse& course) {
  return course.closest_distance().least_mm() - approaches.pairs[course.pair].required_mm;
}

ChartPanel PanelOf(const ReportData& data, const RuledPair& pair, const PairCourse& course) {
  ChartPanel panel;
  const auto name = [&](core::PartIndex part) {
    return Shortened(data.header.layout.parts[part].name, kLongestPartName);
  };
  panel.title = name(pair.a) + " and " + name(pair.b) + ", mm apart";
  panel.low = 0.0;
  ChartLine gap{.name = "gap", .ink = Ink::kSpacing, .points = {}};
  ChartLine at_least{.name = "at least", .ink = Ink::kQuiet, .points = {}, .is_dashed = true};
  for (std::size_t i = 0; i < course.columns.size(); ++i) {
    const std::optional<PairDistance>& column = course.columns[i];
    const bool is_exact = column && column->gap_mm;
    // To the column's end, so that one alone has a width.
    for (const double x : {data.columns.BeginOf(i), data.columns.BeginOf(i + 1)}) {
      gap.points.push_back({x, is_exact ? column->gap_mm : std::nullopt});
      at_least.points.push_back(
          {x, column && !is_exact ? std::optional<double>(column->at_least_mm) : std::nullopt});
    }
  }
  for (ChartLine* line : {&gap, &at_least}) {
    if (std::ranges::any_of(line->points, [](const ChartPoint& point) { return point.y.has_value(); }))
      panel.lines.push_back(std::move(*line));
  }
  if (pair.required_mm > 0.0)
    panel.levels.push_back({pair.required_mm, "required " + Millimetres(pair.required_mm), Ink::kCaution});
  return panel;
}

}  // namespace

const PairSetting* PairApproaches::Find(const std::vector<double>& spacing_mm) const {
  const auto found = std::ranges::lower_bound(judged, spacing_mm, {}, &PairSetting::spacing_mm);
  return found != judged.end() && found->spacing_mm == spacing_mm ? &*found : nullptr;
}

std::vector<PairCourse> CoursesOf(const ReportData& data, const PairApproaches& approaches) {
  std::vector<PairCourse> courses;
  for (std::size_t pair = 0; pair < approaches.pairs.size(); ++pair) {
    courses.push_back({.pair = pair, .columns = {}});
    courses.back().columns.resize(data.columns.count);
  }
  for (std::size_t frame = 0; frame < data.frames.size(); ++frame) {
    const PairSetting* setting = approaches.Find(data.frames[frame].spacing_mm);
    if (setting == nullptr) continue;
    for (PairCourse& course : courses) AddFrame(data, frame, *setting, approaches, &course);
  }
  std::erase_if(courses, [](const PairCourse& course) { return course.closest == nullptr; });
  return courses;
}

Chart PairChart(const ReportData& data, const PairApproaches& approaches,
                const std::vector<PairCourse>& courses) {
  std::vector<const PairCourse*> shown;
  for (const PairCourse& course : courses) shown.push_back(&course);
  std::ranges::stable_sort(shown, {}, [&](const PairCourse* c) { return Margin_mm(approaches, *c); });
  if (shown.size() > kMostPairPanels) shown.resize(kMostPairPanels);
  std::ranges::sort(shown, {}, [](const PairCourse* c) { return c->pair; });
  Chart chart;
  chart.title = "Distance of virtual parts to each other over time";
  chart.x_name = "time, s";
  chart.x_from = data.columns.begin_s;
  chart.x_to = data.columns.end_s;
  chart.zooms = true;
  for (const PairCourse* course : shown)
    chart.panels.push_back(PanelOf(data, approaches.pairs[course->pair], *course));
  return chart;
}

}  // namespace elbowroom::sessions
