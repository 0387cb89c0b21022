#include "sessions/report/timeline_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sessions/report/chart.h"
#include "sessions/report/markup.h"
#include "sessions/report/spacing_line.h"
#include "sessions/report/verdict_text.h"

namespace elbowroom::sessions {
namespace {

constexpr double kPictureWidth = 1040.0;
constexpr double kGutter = 168.0;  // names to the left of the plot
constexpr double kRightMargin = 22.0;
constexpr double kLaneHeight = 34.0;
constexpr double kBarHeight = 20.0;
constexpr double kToolLaneHeight = 22.0;
constexpr double kSpacingHeight = 96.0;
constexpr double kSpacingGap = 26.0;
constexpr double kAxisHeight = 26.0;
constexpr double kLegendHeight = 40.0;
constexpr double kColumnWidth = 2.0;  // of one shade of a bar
constexpr std::size_t kLongestName = 24;

Plot PlotOver(const ReportData& data, double top, double height) {
  Plot plot;
  plot.left = kGutter;
  plot.top = top;
  plot.width = kPictureWidth - kGutter - kRightMargin;
  plot.height = height;
  plot.begin_s = data.begin_s;
  plot.end_s = std::max(data.end_s, data.begin_s + 1e-3);
  return plot;
}

std::string Picture(double height, const std::string& title, const std::string& content) {
  return fmt::format(
      "<svg viewBox='0 0 {0:.0f} {1:.0f}' role='img' aria-label='{2}'><title>{2}</title>{3}</svg>",
      kPictureWidth, height, Escaped(title), content);
}

// Depths in mm that the darkest colour stands for: a round number at or above the deepest.
double DarkestDepth(const ReportData& data) {
  if (!(data.deepest_mm > 0.0)) return 1.0;
  const double step = std::pow(10.0, std::floor(std::log10(data.deepest_mm)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (data.deepest_mm <= factor * step) return factor * step;
  }
  return 10.0 * step;
}

std::string Bar(double x0, double x1, double y, const std::string& colour) {
  return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>", x0, y, x1 - x0,
                     kBarHeight, colour);
}

// A part's contacts, column by column, each in the colour of its deepest moment; equal neighbours are joined.
std::string ContactBars(const ReportData& data, const Plot& plot, core::PartIndex part, double y,
                        double darkest_mm) {
  std::map<int, double> depth_by_column;
  for (const ContactRow& row : data.contacts) {
    if (row.contact.part != part) continue;
    const double depth_mm = row.contact.deepest ? row.contact.deepest->depth_mm : 0.0;
    const auto first = static_cast<int>((plot.X(row.time_s) - plot.left) / kColumnWidth);
    const auto last =
        static_cast<int>((plot.X(row.time_s + data.frame_period_s) - plot.left) / kColumnWidth - 1e-6);
    for (int column = first; column <= std::max(first, last); ++column) {
      double& deepest = depth_by_column.try_emplace(column, depth_mm).first->second;
      deepest = std::max(deepest, depth_mm);
    }
  }
  std::string svg;
  for (auto it = depth_by_column.begin(); it != depth_by_column.end();) {
    const int first = it->first;
    int end = first;
    const std::string colour = DepthColour(it->second / darkest_mm);
    while (it != depth_by_column.end() && it->first == end && DepthColour(it->second / darkest_mm) == colour)
      ++it, ++end;
    svg += Bar(plot.left + first * kColumnWidth, plot.left + end * kColumnWidth, y, colour);
  }
  return svg;
}

// The outline of one touch, with a tooltip.
std::string EpisodeOutline(const ReportData& data, const Plot& plot, const core::ContactEpisode& episode,
                           double y) {
  const double x0 = plot.X(episode.begin_time_s);
  const double x1 = std::max(plot.X(episode.end_time_s + data.frame_period_s), x0 + 2.0 * kColumnWidth);
  const std::string told =
      fmt::format("Touch {} on {}: {:.2f} s to {:.2f} s, {} deep at {:.2f} s", episode.id,
                  data.header.layout.parts[episode.part].name, episode.begin_time_s, episode.end_time_s,
                  Millimetres(episode.peak_depth_mm), episode.peak_time_s);
  return fmt::format(
      "<rect class='touch' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' rx='2'><title>{}</title>"
      "</rect>",
      x0, y, x1 - x0, kBarHeight, Escaped(told));
}

// The numbers of the touches, over the bars; a number that would overlap the one before it is left out.
std::string EpisodeNumbers(const ReportData& data, const Plot& plot, core::PartIndex part, double y) {
  constexpr double kNumberWidth = 16.0;
  std::string svg;
  double free_from = plot.left;
  for (const core::ContactEpisode& episode : data.episodes) {
    if (episode.part != part) continue;
    const double x = plot.X((episode.begin_time_s + episode.end_time_s + data.frame_period_s) / 2.0);
    if (x - kNumberWidth / 2.0 < free_from) continue;
    svg += Label(x, y - 2.0, std::to_string(episode.id), "number", Anchor::kMiddle);
    free_from = x + kNumberWidth / 2.0;
  }
  return svg;
}

std::string PartLane(const ReportData& data, const Plot& plot, core::PartIndex part, double top,
                     double darkest_mm) {
  const double y = top + kLaneHeight - kBarHeight - 3.0;
  const bool is_touched = data.parts[part].frames.frames_in_contact > 0;
  std::string svg = fmt::format("<rect class='lane' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>",
                                plot.left, y, plot.width, kBarHeight);
  svg += Label(kGutter - 12, y + 14.5, Shortened(data.header.layout.parts[part].name, kLongestName),
               is_touched ? "name" : "name quiet", Anchor::kEnd);
  if (!is_touched) return svg + Label(plot.left + 8, y + 14, "no touch", "remark");
  svg += ContactBars(data, plot, part, y, darkest_mm);
  for (const core::ContactEpisode& episode : data.episodes) {
    if (episode.part == part) svg += EpisodeOutline(data, plot, episode, y);
  }
  return svg + EpisodeNumbers(data, plot, part, y);
}

std::vector<std::string> ToolsMarked(const ReportData& data) {
  std::vector<std::string> tools;
  for (const core::SessionEvent& event : data.events) {
    const auto* mark = std::get_if<core::ToolMarked>(&event.what);
    if (mark != nullptr && std::ranges::find(tools, mark->tool) == tools.end()) tools.push_back(mark->tool);
  }
  return tools;
}

std::string ToolLane(const ReportData& data, const Plot& plot, const std::string& tool, double top) {
  std::string svg = Label(kGutter - 12, top + 14, Shortened(tool, kLongestName), "name quiet", Anchor::kEnd);
  std::optional<double> taken_s;
  const auto put_away = [&](double time_s) {
    if (!taken_s) return;
    const double x0 = plot.X(std::clamp(*taken_s, plot.begin_s, plot.end_s));
    const double x1 = plot.X(std::clamp(time_s, plot.begin_s, plot.end_s));
    svg += fmt::format("<rect class='tool' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='8' rx='4'/>", x0,
                       top + 6.0, std::max(x1 - x0, kColumnWidth));
    taken_s.reset();
  };
  for (const core::SessionEvent& event : data.events) {
    const auto* mark = std::get_if<core::ToolMarked>(&event.what);
    if (mark == nullptr || mark->tool != tool) continue;
    if (!mark->in_use) put_away(event.time_s);
    if (mark->in_use && !taken_s) taken_s = event.time_s;
  }
  put_away(data.end_s);
  return svg;
}

std::string DepthLegend(double top, double darkest_mm) {
  constexpr double kWidth = 180.0;
  constexpr int kShades = 36;
  std::string svg = Label(kGutter - 12, top + 21, "depth of touch", "name quiet", Anchor::kEnd);
  for (int i = 0; i < kShades; ++i) {
    svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='10' fill='{}'/>",
                       kGutter + kWidth * i / kShades, top + 12, kWidth / kShades + 0.4,
                       DepthColour((i + 0.5) / kShades));
  }
  svg += Label(kGutter, top + 34, "0", "tick", Anchor::kStart);
  return svg + Label(kGutter + kWidth, top + 34, Millimetres(darkest_mm), "tick", Anchor::kEnd) +
         Label(kGutter + kWidth + 24, top + 21, "numbers: touches, as in the table below", "remark");
}

std::string SpacingPanel(const ReportData& data, const SpacingStudy& study, double top, bool has_axis) {
  const Plot plot = FittedTo(PlotOver(data, top, kSpacingHeight), data, study);
  const std::string& name = data.header.layout.spacings[study.spacing].name;
  return TimeGrid(plot) + ValueAxis(plot, 4) + SpacingLine(plot, data, study) +
         Label(16, top + kSpacingHeight / 2.0, Shortened(name, 18), "name") +
         Label(16, top + kSpacingHeight / 2.0 + 15, "spacing, mm", "remark") +
         (has_axis ? TimeAxis(plot) : "");
}

// Frames in contact, joined to bands.
std::string ContactBands(const ReportData& data, const Plot& plot) {
  std::set<core::FrameIndex> touched;
  for (const ContactRow& row : data.contacts) touched.insert(row.frame);
  std::string svg;
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    if (!touched.contains(data.frames[i].frame)) continue;
    const double x0 = plot.X(data.frames[i].time_s);
    while (i + 1 < data.frames.size() && touched.contains(data.frames[i + 1].frame)) ++i;
    const double x1 = plot.X(data.frames[i].time_s + data.frame_period_s);
    svg += fmt::format("<rect class='contact-band' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>",
                       x0, plot.top, std::max(x1 - x0, 1.0), plot.height);
  }
  return svg;
}

}  // namespace

std::string TimelineChart(const ReportData& data) {
  const double darkest_mm = DarkestDepth(data);
  const std::vector<std::string> tools = ToolsMarked(data);
  const double lanes_top = 4.0 + kToolLaneHeight * static_cast<double>(tools.size());
  const double lanes_height = kLaneHeight * static_cast<double>(data.parts.size()) + 6.0;
  const Plot lanes = PlotOver(data, 4.0, lanes_top - 4.0 + lanes_height);
  std::string svg = TimeGrid(lanes);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    svg += ToolLane(data, lanes, tools[i], 4.0 + kToolLaneHeight * static_cast<double>(i));
  }
  for (core::PartIndex part = 0; part < data.parts.size(); ++part) {
    svg += PartLane(data, lanes, part, lanes_top + kLaneHeight * static_cast<double>(part), darkest_mm);
  }
  double bottom = lanes.bottom();
  if (data.spacings.empty()) svg += TimeAxis(lanes);
  for (std::size_t i = 0; i < data.spacings.size(); ++i) {
    svg += SpacingPanel(data, data.spacings[i], bottom + kSpacingGap, i + 1 == data.spacings.size());
    bottom += kSpacingGap + kSpacingHeight;
  }
  bottom += kAxisHeight;
  svg += DepthLegend(bottom, darkest_mm);
  return Picture(bottom + kLegendHeight, "Touches of each part over time, and the spacings", svg);
}

std::string SpacingChart(const ReportData& data, const SpacingStudy& study) {
  constexpr double kHeight = 190.0;
  const Plot plot = FittedTo(PlotOver(data, 8.0, kHeight), data, study);
  const std::string& name = data.header.layout.spacings[study.spacing].name;
  return Picture(8.0 + kHeight + kAxisHeight, "Spacing " + name + " over time",
                 ContactBands(data, plot) + TimeGrid(plot) + ValueAxis(plot, 6) +
                     SpacingLine(plot, data, study) + TimeAxis(plot) +
                     Label(16, 24, Shortened(name, 18), "name") + Label(16, 39, "mm", "remark"));
}

}  // namespace elbowroom::sessions
