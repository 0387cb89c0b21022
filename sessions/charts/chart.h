// What a chart shows: panels over a common x axis, as values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace elbowroom::sessions {

// Colours by meaning; a page has its own for light and dark (ink.h).
enum class Ink { kText, kQuiet, kGrid, kLane, kSpacing, kTool, kTouched, kFree, kCaution, kContact };

struct ChartPoint {
  double x = 0.0;
  std::optional<double> y;  // nothing: the line has a gap here
};

struct ChartLine {
  std::string name;
  Ink ink = Ink::kSpacing;
  std::vector<ChartPoint> points;  // by x
  bool is_stepped = false;         // each value holds until the next point
  bool is_dashed = false;
  bool has_marks = false;  // a dot at each point
};

// An interval at each x, drawn as an area.
struct ChartBand {
  struct Interval {
    double x = 0.0;
    std::optional<double> low;  // nothing: the area has a gap here
    double high = 0.0;
  };
  std::string name;
  Ink ink = Ink::kSpacing;
  std::vector<Interval> intervals;  // by x
  bool has_whiskers = false;        // each interval as a line with ends, instead of one area
};

// A stretch of x that is shaded over the panel's height.
struct ChartSpan {
  double from = 0.0;
  double to = 0.0;
};

// A value that is marked over the whole width.
struct ChartLevel {
  double y = 0.0;
  std::string name;
  Ink ink = Ink::kCaution;
};

// On a lane of a panel that has lanes.
struct ChartBar {
  double from = 0.0;
  double to = 0.0;
  std::size_t lane = 0;
  std::string color;                      // "#rrggbb"; empty: that of tools
  double height = 0.6;                    // share of the lane's
  bool is_frame = false;                  // only its outline
  std::string told = {};                  // what a tooltip says
  std::optional<std::size_t> touch = {};  // which touch of the page a click selects
};

struct ChartPanel {
  std::string title;
  double height_px = 100.0;
  std::vector<std::string> lanes;  // from the top; a panel with lanes has bars, any other a y axis
  std::vector<ChartBar> bars;
  std::vector<ChartSpan> spans;
  std::vector<ChartBand> bands;
  std::vector<ChartLine> lines;
  std::vector<ChartLevel> levels;
  std::optional<double> low;  // of the y axis; nothing: what the data need
  std::optional<double> high;
  bool counts = false;  // y are whole numbers
};

struct Chart {
  std::string title;   // for those who can't see it
  std::string x_name;  // "time, s"
  double x_from = 0.0;
  double x_to = 1.0;  // > x_from
  std::vector<ChartPanel> panels;
  bool zooms = false;  // in a page, along x
};

}  // namespace elbowroom::sessions
