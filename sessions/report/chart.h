// What the charts of a report share: scales, axes, the depth colours.
#pragma once

#include <string>
#include <vector>

#include "sessions/charts/ink.h"

namespace elbowroom::sessions {

// A rectangle of the picture (SVG user units, y down) over which time runs to the right and a value upwards.
struct Plot {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
  double begin_s = 0.0;
  double end_s = 1.0;  // > begin_s
  double low = 0.0;    // of the value
  double high = 1.0;   // > low

  [[nodiscard]] double X(double time_s) const {
    return left + (time_s - begin_s) / (end_s - begin_s) * width;
  }
  [[nodiscard]] double Y(double value) const { return top + height - (value - low) / (high - low) * height; }
  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
};

// Round numbers (1, 2 or 5 times a power of ten apart) from `low` to `high`, at most `most` of them (>= 2).
[[nodiscard]] std::vector<double> RoundTicks(double low, double high, int most);

// SVG: horizontal grid lines with their values in mm to the left.
[[nodiscard]] std::string ValueAxis(const Plot& plot, int most_ticks);

enum class Anchor { kStart, kMiddle, kEnd };
// SVG: `text` is escaped here; `css_class` is one of the report's style sheet.
[[nodiscard]] std::string Label(double x, double y, const std::string& text, const std::string& css_class,
                                Anchor anchor = Anchor::kStart);

// `text` cut to about `most` characters, with an ellipsis.
[[nodiscard]] std::string Shortened(const std::string& text, std::size_t most);

}  // namespace elbowroom::sessions
