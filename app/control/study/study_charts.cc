#include "app/control/study/study_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "app/control/study/study_text.h"
#include "core/spread.h"
#include "sessions/charts/ink.h"

namespace elbowroom::control {
namespace {

using sessions::Chart;
using sessions::ChartBar;
using sessions::ChartPanel;
using sessions::ColorOf;
using sessions::Ink;

constexpr double kLaneHeightPx = 24.0;
constexpr double kMarkShare = 0.004;  // a mark's width, of the axis

// A round length, 1, 2 or 5 times a power of ten, of which some ten fit into `range`.
class RoundStep {
 public:
  explicit RoundStep(double range) {
    power_ = static_cast<int>(std::floor(std::log10(range))) - 1;
    const double times = range / (10.0 * std::pow(10.0, power_));  // 1 to 10
    times_ = times < 2.0 ? 1.0 : times < 5.0 ? 2.0 : 5.0;
  }

  [[nodiscard]] double size() const { return Times(1.0); }
  // So many steps, as the number nearest to that decimal fraction: an axis shows it.
  [[nodiscard]] double Times(double steps) const {
    const double power = std::pow(10.0, std::abs(power_));  // exact
    return power_ < 0 ? steps * times_ / power : steps * times_ * power;
  }

 private:
  double times_ = 1.0;
  int power_ = 0;
};

// Where an axis begins and ends: at round values, so that all values are on it.
class Extent {
 public:
  void Add(double value) {
    low_ = low_ ? std::min(*low_, value) : value;
    high_ = high_ ? std::max(*high_, value) : value;
  }
  void Add(const std::optional<double>& value) {
    if (value) Add(*value);
  }
  [[nodiscard]] std::pair<double, double> Rounded() const {
    const double low = low_.value_or(0.0), high = high_.value_or(1.0);
    const double size = std::max(std::abs(low), std::abs(high));
    // Values that are one but for rounding have no range to be read off.
    const double margin = std::max(1.0, kMarginShare * size);
    if (high - low <= kSameShare * size) return {std::floor(low - margin), std::ceil(high + margin)};
    const RoundStep step(high - low);
    return {step.Times(std::ceil(low / step.size()) - 1.0), step.Times(std::floor(high / step.size()) + 1.0)};
  }

 private:
  static constexpr double kSameShare = 1e-9, kMarginShare = 1e-3;
  std::optional<double> low_, high_;
};

struct Axis {
  double from = 0.0;
  double to = 1.0;

  [[nodiscard]] ChartBar Mark(double at, std::size_t lane, Ink ink, double height,
                              const std::string& told) const {
    const double half = 0.5 * kMarkShare * (to - from);
    return {at - half, at + half, lane, ColorOf(ink), height, false, told};
  }
};

void AddEstimates(const StudyRow& row, std::size_t lane, const Axis& axis, ChartPanel* panel) {
  const auto told = [&](const char* what, double length_mm) {
    return fmt::format("{}: {} {:.1f} mm", row.participant, what, length_mm);
  };
  if (const auto shortfall_mm = row.shortfall_mm()) {
    const auto [from, to] = std::minmax(*row.estimate_before_mm, *row.needed_mm);
    panel->bars.push_back(
        {from, to, lane, ColorOf(*shortfall_mm > 0.0 ? Ink::kTouched : Ink::kFree), 0.24, false,
         told(*shortfall_mm > 0.0 ? "too little by" : "more than needed by", std::abs(*shortfall_mm))});
  }
  const auto mark = [&](const std::optional<double>& at_mm, Ink ink, double height, const char* what) {
    if (at_mm) panel->bars.push_back(axis.Mark(*at_mm, lane, ink, height, told(what, *at_mm)));
  };
  mark(row.needed_without_tools_mm, Ink::kTool, 0.5, "needed without tools");
  mark(row.estimate_after_mm, Ink::kCaution, 0.7, "estimated after");
  mark(row.estimate_before_mm, Ink::kSpacing, 0.7, "estimated before");
  mark(row.needed_mm, Ink::kText, 0.7, "needed");
}

// Of each participant, the curve of all sessions.
std::vector<review::SpacingCurve> CurvesOfParticipants(const Study& study) {
  std::map<std::string, std::vector<review::SpacingCurve>> by_participant;
  for (const StudySession& session : study.sessions) {
    const auto swept = std::ranges::find(study.sweep.sessions, session.path, &SweptSession::path);
    by_participant[session.participant].push_back(swept->curves.all);
  }
  std::vector<review::SpacingCurve> curves;
  for (const auto& [participant, of_sessions] : by_participant)
    curves.push_back(review::Together(of_sessions));
  return curves;
}

// The share of the frames in which the moved part that is touched most is touched, in per cent.
double TouchedPercent(const review::SpacingCurve& curve, std::size_t step,
                      std::span<const core::PartIndex> moved) {
  std::int64_t most = 0;
  for (const core::PartIndex part : moved)
    most = std::max(most, curve.steps[step].parts[part].frames_in_contact);
  return curve.frames > 0 ? 100.0 * static_cast<double>(most) / static_cast<double>(curve.frames) : 0.0;
}

// At how many participants' motion nothing touches at a gap and at all larger ones: a step at each need.
sessions::ChartLine FreeOfTouches(const std::vector<review::SpacingCurve>& curves,
                                  const SpacingRange& range) {
  std::vector<double> needs_mm;
  for (const review::SpacingCurve& curve : curves)
    if (curve.smallest_free_mm) needs_mm.push_back(*curve.smallest_free_mm);
  std::ranges::sort(needs_mm);
  sessions::ChartLine line{"participants free of touches", Ink::kFree, {{range.from_mm, 0.0}}};
  line.is_stepped = true;
  for (std::size_t i = 0; i < needs_mm.size(); ++i)
    line.points.push_back({needs_mm[i], static_cast<double>(i + 1)});
  line.points.push_back({range.to_mm, static_cast<double>(needs_mm.size())});
  return line;
}

void AddConditions(const ByCondition& by_condition, const Axis& axis, const std::string& measure,
                   ChartPanel* panel) {
  std::size_t lane = 0;
  for (const auto& [condition, by_participant] : by_condition) {
    std::vector<double> values;
    for (const auto& [participant, value] : by_participant) values.push_back(value);
    const core::Summary summary = core::Summarise(values);
    if (const auto interval = core::MeanInterval(summary, kConfidence))
      panel->bars.push_back({interval->lower, interval->upper, lane, ColorOf(Ink::kSpacing), 0.3, true,
                             fmt::format("{}: 95 % interval of the mean {:.4g} to {:.4g}", condition,
                                         interval->lower, interval->upper)});
    for (const auto& [participant, value] : by_participant)
      panel->bars.push_back(axis.Mark(value, lane, Ink::kQuiet, 0.3,
                                      fmt::format("{}, {}: {:.4g}", condition, participant, value)));
    panel->bars.push_back(
        axis.Mark(summary.mean, lane, Ink::kText, 0.75,
                  fmt::format("{}: mean {} {:.4g} (n = {})", condition, measure, summary.mean, summary.n)));
    panel->lanes.push_back(condition);
    ++lane;
  }
}

Chart ConditionChart(const std::string& name, const ByCondition& by_condition) {
  Extent extent;
  for (const auto& [condition, by_participant] : by_condition) {
    std::vector<double> values;
    for (const auto& [participant, value] : by_participant) values.push_back(value);
    for (const double value : values) extent.Add(value);
    if (const auto interval = core::MeanInterval(core::Summarise(values), kConfidence)) {
      extent.Add(interval->lower);
      extent.Add(interval->upper);
    }
  }
  const auto [from, to] = extent.Rounded();
  Chart chart{fmt::format("{} by condition", name), name, from, to, {}};
  ChartPanel panel;
  panel.height_px = kLaneHeightPx * static_cast<double>(by_condition.size());
  AddConditions(by_condition, {from, to}, name, &panel);
  chart.panels.push_back(std::move(panel));
  return chart;
}

}  // namespace

Chart EstimateChart(const Study& study) {
  Extent extent;
  for (const StudyRow& row : study.rows)
    for (const auto& length_mm :
         {row.estimate_before_mm, row.needed_without_tools_mm, row.needed_mm, row.estimate_after_mm})
      extent.Add(length_mm);
  const auto [from, to] = extent.Rounded();
  Chart chart{
      "Estimates and space needed, by participant", fmt::format("{}, mm", study.range.spacing), from, to, {}};
  ChartPanel panel;
  for (const StudyRow& row : study.rows) {
    AddEstimates(row, panel.lanes.size(), {from, to}, &panel);
    panel.lanes.push_back(row.participant);
  }
  panel.height_px = kLaneHeightPx * static_cast<double>(panel.lanes.size());
  if (!panel.bars.empty()) chart.panels.push_back(std::move(panel));
  return chart;
}

Chart NeedChart(const Study& study) {
  const std::vector<review::SpacingCurve> curves = CurvesOfParticipants(study);
  sessions::ChartBand spread{"from the least to the greatest", Ink::kContact, {}};
  sessions::ChartLine median{"median of the participants, %", Ink::kTouched, {}};
  for (std::size_t step = 0; step < study.sweep.all.all.steps.size(); ++step) {
    const double spacing_mm = study.sweep.all.all.steps[step].spacing_mm;
    std::vector<double> touched;
    for (const review::SpacingCurve& curve : curves)
      touched.push_back(TouchedPercent(curve, step, study.sweep.moved));
    std::ranges::sort(touched);
    spread.intervals.push_back({spacing_mm, touched.front(), touched.back()});
    median.points.push_back({spacing_mm, core::PercentileOf(touched, 0.5)});
  }
  Chart chart{"Touches over the gap, of all participants",
              fmt::format("{}, mm", study.range.spacing),
              study.range.from_mm,
              std::max(study.range.to_mm, study.range.from_mm + 1.0),
              {}};
  ChartPanel touches;
  touches.title = "Frames in contact, %";
  touches.height_px = 180.0;
  touches.low = 0.0;
  touches.bands = {std::move(spread)};
  touches.lines = {std::move(median)};
  ChartPanel participants;
  participants.title = fmt::format("Participants free of touches, of {}", study.rows.size());
  participants.height_px = 110.0;
  participants.low = 0.0;
  participants.counts = true;
  participants.lines = {FreeOfTouches(curves, study.range)};
  chart.panels = {std::move(touches), std::move(participants)};
  return chart;
}

std::vector<Chart> ConditionCharts(const Study& study) {
  // By measure: the smallest decisive p.
  std::map<std::string, double> surest;
  for (const Comparison& comparison : study.comparisons) {
    const double p = comparison.decisive_p.value_or(2.0);  // without a test: after all others
    const auto [known, is_new] = surest.emplace(comparison.measure, p);
    if (!is_new) known->second = std::min(known->second, p);
  }
  std::vector<std::string> measures;  // by name
  for (const auto& [measure, p] : surest) measures.push_back(measure);
  std::ranges::stable_sort(measures, {}, [&](const std::string& measure) { return surest.at(measure); });
  if (measures.size() > kMostConditionCharts) measures.resize(kMostConditionCharts);
  std::vector<Chart> charts;
  for (const std::string& measure : measures)
    charts.push_back(ConditionChart(NameOfCompared(measure, study.baseline), study.compared.at(measure)));
  return charts;
}

}  // namespace elbowroom::control
