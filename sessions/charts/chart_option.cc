#include "sessions/charts/chart_option.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "sessions/charts/ink.h"

namespace elbowroom::sessions {
namespace {

using Json = nlohmann::json;

constexpr double kTop = 8.0;           // above the first panel
constexpr double kTitleHeight = 24.0;  // above a panel with a title
constexpr double kPanelGap = 14.0;
constexpr double kAxisHeight = 46.0;  // below the last panel
constexpr double kGutter = 168.0;     // names to the left of the panels
constexpr double kRightMargin = 22.0;
constexpr double kSmallFont = 11.5;
constexpr double kFont = 12.5;

Json Style(Ink ink, double size = kFont) { return {{"color", ColorOf(ink)}, {"fontSize", size}}; }

Json Number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(); }

double TopOf(const Chart& chart, std::size_t panel) {
  double top = kTop;
  for (std::size_t i = 0; i < panel; ++i) top += chart.panels[i].height_px + kPanelGap;
  for (std::size_t i = 0; i <= panel && i < chart.panels.size(); ++i)
    top += chart.panels[i].title.empty() ? 0.0 : kTitleHeight;
  return top;
}

Json XAxis(const Chart& chart, std::size_t panel) {
  const bool is_last = panel + 1 == chart.panels.size();
  Json axis = {{"gridIndex", panel},
               {"type", "value"},
               {"min", chart.x_from},
               {"max", chart.x_to},
               {"axisLine", {{"onZero", false}, {"lineStyle", {{"color", ColorOf(Ink::kQuiet)}}}}},
               {"axisTick", {{"show", is_last}}},
               {"axisLabel", Style(Ink::kQuiet, kSmallFont)},
               {"splitLine", {{"lineStyle", {{"color", ColorOf(Ink::kGrid)}}}}}};
  axis["axisLabel"]["show"] = is_last;
  axis["axisLabel"]["showMaxLabel"] = false;
  if (is_last) {
    axis["name"] = chart.x_name;
    axis["nameLocation"] = "middle";
    axis["nameGap"] = 28;
    axis["nameTextStyle"] = Style(Ink::kQuiet, kSmallFont);
  }
  return axis;
}

Json LaneAxis(const ChartPanel& panel, std::size_t index) {
  Json axis = {
      {"gridIndex", index},
      {"type", "category"},
      {"inverse", true},
      {"data", panel.lanes},
      {"axisLine", {{"show", false}}},
      {"axisTick", {{"show", false}}},
      {"splitArea", {{"show", true}, {"areaStyle", {{"color", {ColorOf(Ink::kLane), "transparent"}}}}}},
      {"axisLabel", Style(Ink::kText)}};
  axis["axisLabel"].update({{"width", kGutter - 20.0}, {"overflow", "truncate"}, {"interval", 0}});
  return axis;
}

Json ValueAxis(const ChartPanel& panel, std::size_t index) {
  Json axis = {{"gridIndex", index},
               {"type", "value"},
               {"scale", true},
               {"splitNumber", panel.height_px < 120.0 ? 3 : 5},
               {"axisLabel", Style(Ink::kQuiet, kSmallFont)},
               {"splitLine", {{"lineStyle", {{"color", ColorOf(Ink::kGrid)}}}}}};
  if (panel.low) axis["min"] = Number(panel.low);
  if (panel.high) axis["max"] = Number(panel.high);
  if (panel.counts) axis["minInterval"] = 1;
  axis["axisLabel"]["hideOverlap"] = true;
  if (panel.high) axis["axisLabel"]["showMaxLabel"] = false;  // the end of the range, beside a round number
  return axis;
}

Json YAxis(const ChartPanel& panel, std::size_t index) {
  Json axis = panel.lanes.empty() ? ValueAxis(panel, index) : LaneAxis(panel, index);
  axis["name"] = panel.title;
  axis["nameLocation"] = panel.lanes.empty() ? "end" : "start";  // a lane axis runs downwards
  axis["nameGap"] = 8;
  axis["nameTextStyle"] = Style(Ink::kText);
  axis["nameTextStyle"]["align"] = "left";
  return axis;
}

Json SeriesOn(std::size_t panel, const std::string& name, const char* type) {
  return {{"type", type}, {"name", name},       {"xAxisIndex", panel},   {"yAxisIndex", panel},
          {"clip", true}, {"animation", false}, {"data", Json::array()}, {"emphasis", {{"disabled", true}}}};
}

Json LineSeries(const ChartLine& line, std::size_t panel) {
  Json series = SeriesOn(panel, line.name, "line");
  series["color"] = ColorOf(line.ink);
  series["showSymbol"] = line.has_marks;
  series["symbol"] = "circle";
  series["symbolSize"] = 5;
  series["lineStyle"] = {{"color", ColorOf(line.ink)}, {"width", 1.8}};
  if (line.is_dashed) series["lineStyle"]["type"] = {6, 4};
  if (line.is_stepped) series["step"] = "end";
  for (const ChartPoint& point : line.points) series["data"].push_back({point.x, Number(point.y)});
  return series;
}

Json BandSeries(const ChartBand& band, std::size_t panel) {
  Json series = SeriesOn(panel, band.name, "custom");
  series["renderItem"] = band.has_whiskers ? "@whisker" : "@band";
  series["color"] = ColorOf(band.ink);
  series["encode"] = {{"x", 0}, {"y", {1, 2}}};
  for (const ChartBand::Interval& at : band.intervals)
    series["data"].push_back({at.x, Number(at.low), at.low ? Number(at.high) : Json()});
  return series;
}

// The bars, or the frames, of a panel with lanes.
Json BarSeries(const ChartPanel& panel, std::size_t index, bool frames) {
  Json series = SeriesOn(index, frames ? "touches" : "bars", "custom");
  series["renderItem"] = frames ? "@frame" : "@bar";
  series["encode"] = {{"x", {0, 1}}, {"y", 2}};
  series["tooltip"] = {{"trigger", "item"}, {"formatter", "@told"}};
  series["silent"] = !frames;
  for (const ChartBar& bar : panel.bars) {
    if (bar.is_frame != frames) continue;
    Json item = {{"value", {bar.from, bar.to, bar.lane, bar.height}},
                 {"itemStyle", {{"color", bar.color.empty() ? ColorOf(Ink::kTool) : bar.color}}}};
    if (!bar.told.empty()) item["told"] = bar.told;
    if (bar.touch) item["touch"] = *bar.touch;
    series["data"].push_back(std::move(item));
  }
  return series;
}

// Spans and levels, on a line of no points.
Json MarkSeries(const ChartPanel& panel, std::size_t index) {
  Json series = SeriesOn(index, "marks", "line");
  series["silent"] = true;
  series["tooltip"] = {{"show", false}};
  Json areas = Json::array(), levels = Json::array();
  for (const ChartSpan& span : panel.spans) areas.push_back({{{"xAxis", span.from}}, {{"xAxis", span.to}}});
  for (const ChartLevel& level : panel.levels) {
    Json label = Style(level.ink, kSmallFont);
    label.update({{"formatter", level.name}, {"position", "insideEndTop"}, {"show", true}});
    levels.push_back({{"yAxis", level.y},
                      {"name", level.name},
                      {"label", std::move(label)},
                      {"lineStyle", {{"color", ColorOf(level.ink)}, {"type", {6, 4}}, {"width", 1.4}}}});
  }
  series["markArea"] = {
      {"silent", true}, {"itemStyle", {{"color", ColorOf(Ink::kContact)}}}, {"data", areas}};
  series["markLine"] = {{"silent", true}, {"symbol", "none"}, {"data", levels}};
  return series;
}

void AddPanel(const Chart& chart, std::size_t index, Json* option) {
  const ChartPanel& panel = chart.panels[index];
  (*option)["grid"].push_back({{"left", kGutter},
                               {"right", kRightMargin},
                               {"top", TopOf(chart, index)},
                               {"height", panel.height_px},
                               {"containLabel", false}});
  (*option)["xAxis"].push_back(XAxis(chart, index));
  (*option)["yAxis"].push_back(YAxis(panel, index));
  Json& series = (*option)["series"];
  if (!panel.spans.empty() || !panel.levels.empty()) series.push_back(MarkSeries(panel, index));
  for (const ChartBand& band : panel.bands) series.push_back(BandSeries(band, index));
  for (const ChartLine& line : panel.lines) series.push_back(LineSeries(line, index));
  if (!panel.lanes.empty()) series.push_back(BarSeries(panel, index, false));
  if (!panel.lanes.empty()) series.push_back(BarSeries(panel, index, true));
}

std::string WithoutMarkup(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace

double HeightOf(const Chart& chart) {
  if (chart.panels.empty()) return kTop + kAxisHeight;
  return TopOf(chart, chart.panels.size() - 1) + chart.panels.back().height_px + kAxisHeight;
}

std::string OptionJson(const Chart& chart) {
  core::Require(chart.x_from < chart.x_to, "a chart's x axis has a length");
  Json option = {
      {"animation", false},
      {"textStyle",
       {{"fontFamily", "Segoe UI, Helvetica Neue, Arial, Liberation Sans, DejaVu Sans, sans-serif"}}},
      {"tooltip",
       {{"trigger", "axis"},
        {"confine", true},
        {"formatter", "@values"},
        {"backgroundColor", "var(--paper)"},
        {"borderColor", "var(--line)"},
        {"textStyle", Style(Ink::kText)},
        {"axisPointer", {{"lineStyle", {{"color", ColorOf(Ink::kQuiet)}}}}}}},
      {"grid", Json::array()},
      {"xAxis", Json::array()},
      {"yAxis", Json::array()},
      {"series", Json::array()}};
  if (chart.panels.size() > 1) option["axisPointer"] = {{"link", {{{"xAxisIndex", "all"}}}}};
  if (chart.zooms) option["zooms"] = true;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) AddPanel(chart, i, &option);
  return WithoutMarkup(option.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace elbowroom::sessions
