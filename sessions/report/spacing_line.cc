#include "sessions/report/spacing_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

// A value is written where it is held long enough for its text.
constexpr double kLabelWidth = 52.0;

bool ShowsEstimate(const ReportData& data, const SpacingStudy& study) {
  return data.header.trial.estimate_mm > 0.0 && data.judged_spacing == study.spacing;
}

std::string EstimateLine(const Plot& plot, double estimate_mm) {
  const double y = plot.Y(estimate_mm);
  return fmt::format("<line class='estimate' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>", plot.left,
                     plot.right(), y, y) +
         Label(plot.right(), y + 13, "estimate " + Millimetres(estimate_mm), "estimate-text", Anchor::kEnd);
}

}  // namespace

Plot FittedTo(Plot plot, const ReportData& data, const SpacingStudy& study) {
  double low = study.levels.front().spacing_mm, high = study.levels.back().spacing_mm;
  if (ShowsEstimate(data, study)) {
    low = std::min(low, data.header.trial.estimate_mm);
    high = std::max(high, data.header.trial.estimate_mm);
  }
  const double margin = std::max(0.35 * (high - low), 5.0);
  plot.low = low - margin;
  plot.high = high + margin;
  return plot;
}

std::string SpacingLine(const Plot& plot, const ReportData& data, const SpacingStudy& study) {
  std::string svg = ShowsEstimate(data, study) ? EstimateLine(plot, data.header.trial.estimate_mm) : "";
  std::string path, labels;
  for (std::size_t i = 0; i < study.steps.size(); ++i) {
    const double end_s = i + 1 < study.steps.size() ? study.steps[i + 1].time_s : data.end_s;
    const double x0 = plot.X(study.steps[i].time_s), x1 = plot.X(end_s),
                 y = plot.Y(study.steps[i].spacing_mm);
    path += fmt::format("{}{:.1f} {:.1f}H{:.1f}", i == 0 ? 'M' : 'L', x0, y, x1);
    if (x1 - x0 >= kLabelWidth)
      labels += Label(x0 + 6, y - 6, Millimetres(study.steps[i].spacing_mm), "value");
  }
  return svg + "<path class='spacing' d='" + path + "'/>" + labels;
}

}  // namespace elbowroom::sessions
