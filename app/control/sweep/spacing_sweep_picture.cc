#include "app/control/sweep/spacing_sweep_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "app/control/sweep/sweep_files.h"
#include "core/infinity.h"
#include "sessions/report/chart.h"

namespace elbowroom::control {
namespace {

using Anchor = LineDrawing::Anchor;

constexpr int kChartWidthPx = 900;
constexpr int kChartHeightPx = 620;
constexpr double kLeft = 80.0;
constexpr double kPlotWidth = 780.0;
constexpr const char* kGridColor = "#dddddd";
constexpr const char* kAxis = "#555555";
constexpr const char* kFree = "#2a7f3b";
constexpr const char* kWithClearance = "#1b5e8a";
constexpr const char* kEstimate = "#8a6d00";
// The parts' colours: for lines, and for the bands between a clearance's bounds.
constexpr std::array<const char*, 5> kCurveColors = {"#b2182b", "#2166ac", "#7b3294", "#01665e", "#b35806"};
constexpr std::array<const char*, 5> kPaleColors = {"#f4c5bd", "#c3d9ec", "#dcc9e4", "#bfe0dc", "#f3d7b6"};

// The spacing runs to the right, in the members of sessions::Plot that are named after time.
sessions::Plot PlotAt(double top, double height, const review::SpacingCurve& curve, double high) {
  sessions::Plot plot;
  plot.left = kLeft;
  plot.top = top;
  plot.width = kPlotWidth;
  plot.height = height;
  plot.begin_s = curve.steps.front().spacing_mm;
  plot.end_s = std::max(curve.steps.back().spacing_mm, plot.begin_s + 1.0);
  plot.high = high;
  return plot;
}

void AddAxes(const sessions::Plot& plot, const std::string& title, LineDrawing* drawing) {
  for (const double value : sessions::RoundTicks(plot.low, plot.high, 6)) {
    drawing->lines.push_back({{{plot.left, plot.Y(value)}, {plot.right(), plot.Y(value)}}, kGridColor});
    drawing->texts.push_back(
        {{plot.left - 8.0, plot.Y(value) + 4.0}, fmt::format("{:.6g}", value), Anchor::kEnd});
  }
  for (const double spacing_mm : sessions::RoundTicks(plot.begin_s, plot.end_s, 12)) {
    drawing->lines.push_back(
        {{{plot.X(spacing_mm), plot.top}, {plot.X(spacing_mm), plot.bottom()}}, kGridColor});
    drawing->texts.push_back(
        {{plot.X(spacing_mm), plot.bottom() + 18.0}, fmt::format("{:.6g}", spacing_mm), Anchor::kMiddle});
  }
  drawing->lines.push_back({{{plot.left, plot.bottom()}, {plot.right(), plot.bottom()}}, kAxis, 1.5});
  drawing->texts.push_back({{plot.left, plot.top - 10.0}, title, Anchor::kStart, 14.0});
}

// A line of the colour. Its text stands at the plot's right end, where curves of contact are low.
void AddMark(const sessions::Plot& plot, double spacing_mm, const char* color, LineDrawing* drawing) {
  if (spacing_mm < plot.begin_s || spacing_mm > plot.end_s) return;
  const double x = plot.X(spacing_mm);
  drawing->lines.push_back({{{x, plot.top}, {x, plot.bottom()}}, color, 2.0});
}

// The smallest and the largest of the participants' estimates.
std::string EstimatesText(const SpacingSweep& sweep) {
  double least_mm = core::kInfinity, most_mm = 0.0;
  for (const SweptSession& session : sweep.sessions) {
    if (!(session.estimate_mm > 0.0)) continue;
    least_mm = std::min(least_mm, session.estimate_mm);
    most_mm = std::max(most_mm, session.estimate_mm);
  }
  if (!(most_mm > 0.0)) return {};
  if (least_mm == most_mm) return fmt::format("estimate {:.6g} mm", most_mm);
  return fmt::format("estimates {:.6g} to {:.6g} mm", least_mm, most_mm);
}

void AddMarks(const SpacingSweep& sweep, const sessions::Plot& plot, LineDrawing* drawing) {
  for (const SweptSession& session : sweep.sessions)
    if (session.estimate_mm > 0.0) AddMark(plot, session.estimate_mm, kEstimate, drawing);
  if (sweep.all.all.smallest_free_mm) AddMark(plot, *sweep.all.all.smallest_free_mm, kFree, drawing);
  if (const auto clear_mm = SmallestWithClearanceMm(sweep, sweep.all.all))
    AddMark(plot, *clear_mm, kWithClearance, drawing);
}

void AddMarkTexts(const SpacingSweep& sweep, const sessions::Plot& plot, LineDrawing* drawing) {
  double y = plot.top + 16.0;
  const auto add = [&](const std::string& text, const char* color) {
    if (text.empty()) return;
    drawing->texts.push_back({{plot.right() - 8.0, y}, text, Anchor::kEnd, 13.0, color});
    y += 18.0;
  };
  add(EstimatesText(sweep), kEstimate);
  if (const auto free_mm = sweep.all.all.smallest_free_mm)
    add(fmt::format("no contact from {:.6g} mm on", *free_mm), kFree);
  if (const auto clear_mm = SmallestWithClearanceMm(sweep, sweep.all.all))
    add(fmt::format("required clearance from {:.6g} mm on", *clear_mm), kWithClearance);
}

// The upper end of the clearance axis: a little above the largest finite upper bound of the moved parts.
double HighestMm(const SpacingSweep& sweep) {
  double highest_mm = 1.0;
  for (const SweptSession& session : sweep.sessions)
    for (const review::StudyStep& step : session.curves.all.steps)
      for (const core::PartIndex part : sweep.moved)
        if (std::isfinite(step.parts[part].upper_mm))
          highest_mm = std::max(highest_mm, step.parts[part].upper_mm);
  return 1.05 * highest_mm;
}

// What the upper plot shows: frames, or of several sessions per cent of them.
double ContactShare(const SpacingSweep& sweep, const review::SpacingCurve& curve,
                    const review::PartAtSpacing& part) {
  const auto frames = static_cast<double>(part.frames_in_contact);
  if (sweep.sessions.size() == 1) return frames;
  return 100.0 * frames / static_cast<double>(std::max<std::int64_t>(curve.frames, 1));
}

double HighestShare(const SpacingSweep& sweep) {
  double highest = 1.0;
  for (const SweptSession& session : sweep.sessions)
    for (const review::StudyStep& step : session.curves.all.steps)
      for (const core::PartIndex part : sweep.moved)
        highest = std::max(highest, ContactShare(sweep, session.curves.all, step.parts[part]));
  return 1.05 * highest;
}

// A dot where a step was judged; the lines between dots only join them.
LineDrawing::Area DotAt(const LineDrawing::Point& at, const char* color) {
  constexpr double kHalf = 3.5;
  return {{{at.x - kHalf, at.y - kHalf}, {at.x + kHalf, at.y + kHalf}}, color};
}

// The two plots of the picture.
struct Plots {
  sessions::Plot contact;
  sessions::Plot clearance;
};

// A part's curve of one of several sessions.
void AddThin(const SpacingSweep& sweep, const review::SpacingCurve& curve, core::PartIndex part,
             std::size_t color, const Plots& plots, LineDrawing* drawing) {
  LineDrawing::Line contacts{{}, kPaleColors[color], 1.0}, upper = contacts;
  for (const review::StudyStep& step : curve.steps) {
    const review::PartAtSpacing& at = step.parts[part];
    const double x = plots.contact.X(step.spacing_mm);
    contacts.points.push_back({x, plots.contact.Y(ContactShare(sweep, curve, at))});
    if (std::isfinite(at.upper_mm)) upper.points.push_back({x, plots.clearance.Y(at.upper_mm)});
  }
  drawing->lines.push_back(contacts);
  drawing->lines.push_back(upper);
}

void AddThick(const SpacingSweep& sweep, core::PartIndex part, std::size_t color, const Plots& plots,
              LineDrawing* drawing) {
  const bool is_one = sweep.sessions.size() == 1;
  LineDrawing::Line contacts{{}, kCurveColors[color], is_one ? 2.0 : 3.0},
      lower{{}, kCurveColors[color], 1.0}, upper{{}, kCurveColors[color], is_one ? 1.0 : 2.0};
  LineDrawing::Area band{{}, kPaleColors[color]};
  for (const review::StudyStep& step : sweep.all.all.steps) {
    const review::PartAtSpacing& at = step.parts[part];
    const double x = plots.contact.X(step.spacing_mm),
                 y = plots.contact.Y(ContactShare(sweep, sweep.all.all, at));
    contacts.points.push_back({x, y});
    drawing->areas.push_back(DotAt({x, y}, kCurveColors[color]));
    if (!std::isfinite(at.upper_mm)) continue;
    drawing->areas.push_back(DotAt({x, plots.clearance.Y(at.upper_mm)}, kCurveColors[color]));
    lower.points.push_back({x, plots.clearance.Y(at.lower_mm)});
    upper.points.push_back({x, plots.clearance.Y(at.upper_mm)});
  }
  band.points = upper.points;
  band.points.insert(band.points.end(), lower.points.rbegin(), lower.points.rend());
  if (band.points.size() > 2) drawing->areas.push_back(band);
  for (LineDrawing::Line& line : std::array{contacts, lower, upper}) drawing->lines.push_back(line);
}

void AddLegend(const SpacingSweep& sweep, LineDrawing* drawing) {
  double legend_x = kLeft;
  for (std::size_t i = 0; i < sweep.moved.size(); ++i) {
    const std::string& name = sweep.parts[sweep.moved[i]];
    drawing->areas.push_back(
        {{{legend_x, 24.0}, {legend_x + 14.0, 34.0}}, kCurveColors[i % kCurveColors.size()]});
    drawing->texts.push_back({{legend_x + 20.0, 34.0}, name, Anchor::kStart, 14.0});
    legend_x += 50.0 + 9.0 * static_cast<double>(name.size());
  }
  if (sweep.sessions.size() > 1)
    drawing->texts.push_back({{kLeft + kPlotWidth, 34.0},
                              fmt::format("{} sessions: each thin, all thick", sweep.sessions.size()),
                              Anchor::kEnd,
                              14.0});
}

}  // namespace

LineDrawing SpacingSweepPicture(const SpacingSweep& sweep, const std::string& spacing) {
  LineDrawing drawing;
  drawing.width_px = kChartWidthPx;
  drawing.height_px = kChartHeightPx;
  const bool is_one = sweep.sessions.size() == 1;
  const Plots plots{PlotAt(72.0, 200.0, sweep.all.all, HighestShare(sweep)),
                    PlotAt(344.0, 200.0, sweep.all.all, HighestMm(sweep))};
  AddAxes(plots.contact, is_one ? "frames in contact" : "frames in contact, per cent", &drawing);
  AddAxes(plots.clearance, "least clearance over all frames, mm: between its two bounds", &drawing);
  for (std::size_t i = 0; i < sweep.moved.size() && !is_one; ++i)
    for (const SweptSession& session : sweep.sessions)
      AddThin(sweep, session.curves.all, sweep.moved[i], i % kCurveColors.size(), plots, &drawing);
  for (std::size_t i = 0; i < sweep.moved.size(); ++i)
    AddThick(sweep, sweep.moved[i], i % kCurveColors.size(), plots, &drawing);
  AddLegend(sweep, &drawing);
  AddMarks(sweep, plots.contact, &drawing);
  AddMarks(sweep, plots.clearance, &drawing);
  AddMarkTexts(sweep, plots.contact, &drawing);
  drawing.texts.push_back({{kLeft + 0.5 * kPlotWidth, kChartHeightPx - 22.0},
                           fmt::format("{}, mm", spacing),
                           Anchor::kMiddle,
                           14.0});
  return drawing;
}

}  // namespace elbowroom::control
