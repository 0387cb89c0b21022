#include "app/control/sweep/spacing_sweep_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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
constexpr const char* kEstimate = "#8a6d00";
// The parts' colours: for lines, and for the bands between a clearance's bounds.
constexpr std::array<const char*, 5> kCurveColors = {"#b2182b", "#2166ac", "#7b3294", "#01665e", "#b35806"};
constexpr std::array<const char*, 5> kPaleColors = {"#f4c5bd", "#c3d9ec", "#dcc9e4", "#bfe0dc", "#f3d7b6"};

// The spacing runs to the right, in the members of sessions::Plot that are named after time.
sessions::Plot PlotAt(double top, double height, const review::SpacingStudy& study, double high) {
  sessions::Plot plot;
  plot.left = kLeft;
  plot.top = top;
  plot.width = kPlotWidth;
  plot.height = height;
  plot.begin_s = study.steps.front().spacing_mm;
  plot.end_s = std::max(study.steps.back().spacing_mm, plot.begin_s + 1.0);
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

void AddMark(const sessions::Plot& plot, double spacing_mm, const std::string& text, const char* color,
             double text_y, LineDrawing* drawing) {
  if (spacing_mm < plot.begin_s || spacing_mm > plot.end_s) return;
  const double x = plot.X(spacing_mm);
  drawing->lines.push_back({{{x, plot.top}, {x, plot.bottom()}}, color, 2.0});
  if (text.empty()) return;
  const bool is_left = x < plot.left + 0.5 * plot.width;
  drawing->texts.push_back(
      {{is_left ? x + 6.0 : x - 6.0, text_y}, text, is_left ? Anchor::kStart : Anchor::kEnd, 13.0, color});
}

void AddMarks(const core::SessionHeader& header, const review::SpacingStudy& study,
              const sessions::Plot& plot, bool has_text, LineDrawing* drawing) {
  const double estimate_mm = header.trial.estimate_mm;
  if (estimate_mm > 0.0) {
    AddMark(plot, estimate_mm, has_text ? fmt::format("estimate {:.6g} mm", estimate_mm) : "", kEstimate,
            plot.top + 16.0, drawing);
  }
  if (study.smallest_free_mm) {
    AddMark(plot, *study.smallest_free_mm,
            has_text ? fmt::format("no contact from {:.1f} mm on", *study.smallest_free_mm) : "", kFree,
            plot.top + 34.0, drawing);
  }
}

// The upper end of the clearance axis: a little above the largest finite upper bound of the moved parts.
double HighestMm(const review::SpacingStudy& study) {
  double highest_mm = 1.0;
  for (const review::StudyStep& step : study.steps) {
    for (const core::PartIndex part : study.moved) {
      const double upper_mm = step.parts[part].upper_mm;
      if (std::isfinite(upper_mm)) highest_mm = std::max(highest_mm, upper_mm);
    }
  }
  return 1.05 * highest_mm;
}

// A dot where a step was judged; the lines between dots only join them.
LineDrawing::Area DotAt(const LineDrawing::Point& at, const char* color) {
  constexpr double kHalf = 3.5;
  return {{{at.x - kHalf, at.y - kHalf}, {at.x + kHalf, at.y + kHalf}}, color};
}

void AddPart(const review::SpacingStudy& study, core::PartIndex part, std::size_t color,
             const sessions::Plot& frames, const sessions::Plot& clearance, LineDrawing* drawing) {
  LineDrawing::Line contacts{{}, kCurveColors[color], 2.0}, lower{{}, kCurveColors[color], 1.0},
      upper = lower;
  LineDrawing::Area band{{}, kPaleColors[color]};
  for (const review::StudyStep& step : study.steps) {
    const review::PartAtSpacing& at = step.parts[part];
    const double x = frames.X(step.spacing_mm), y = frames.Y(static_cast<double>(at.frames_in_contact));
    contacts.points.push_back({x, y});
    drawing->areas.push_back(DotAt({x, y}, kCurveColors[color]));
    if (!std::isfinite(at.upper_mm)) continue;
    drawing->areas.push_back(DotAt({x, clearance.Y(at.upper_mm)}, kCurveColors[color]));
    lower.points.push_back({x, clearance.Y(at.lower_mm)});
    upper.points.push_back({x, clearance.Y(at.upper_mm)});
  }
  band.points = upper.points;
  band.points.insert(band.points.end(), lower.points.rbegin(), lower.points.rend());
  if (band.points.size() > 2) drawing->areas.push_back(band);
  for (LineDrawing::Line& line : std::array{contacts, lower, upper}) drawing->lines.push_back(line);
}

}  // namespace

LineDrawing SpacingSweepPicture(const core::SessionHeader& header, const std::string& spacing,
                                const review::SpacingStudy& study) {
  LineDrawing drawing;
  drawing.width_px = kChartWidthPx;
  drawing.height_px = kChartHeightPx;
  double most_frames = 1.0;
  for (const review::StudyStep& step : study.steps) {
    for (const core::PartIndex part : study.moved)
      most_frames = std::max(most_frames, static_cast<double>(step.parts[part].frames_in_contact));
  }
  const sessions::Plot frames = PlotAt(72.0, 200.0, study, 1.05 * most_frames),
                       clearance = PlotAt(344.0, 200.0, study, HighestMm(study));
  AddAxes(frames, "frames in contact", &drawing);
  AddAxes(clearance, "least clearance over all frames, mm: between its two bounds", &drawing);
  double legend_x = kLeft;
  for (std::size_t i = 0; i < study.moved.size(); ++i) {
    const std::size_t color = i % kCurveColors.size();
    AddPart(study, study.moved[i], color, frames, clearance, &drawing);
    const std::string& name = header.layout.parts[study.moved[i]].name;
    drawing.areas.push_back({{{legend_x, 24.0}, {legend_x + 14.0, 34.0}}, kCurveColors[color]});
    drawing.texts.push_back({{legend_x + 20.0, 34.0}, name, Anchor::kStart, 14.0});
    legend_x += 50.0 + 9.0 * static_cast<double>(name.size());
  }
  AddMarks(header, study, frames, true, &drawing);
  AddMarks(header, study, clearance, false, &drawing);
  drawing.texts.push_back({{kLeft + 0.5 * kPlotWidth, kChartHeightPx - 22.0},
                           fmt::format("{}, mm", spacing),
                           Anchor::kMiddle,
                           14.0});
  return drawing;
}

}  // namespace elbowroom::control
