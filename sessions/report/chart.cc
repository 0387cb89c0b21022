#include "sessions/report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "sessions/report/markup.h"

namespace elbowroom::sessions {
std::vector<double> RoundTicks(double low, double high, int most) {
  core::Require(most >= 2 && low < high, "an axis has a length and at least two ticks");
  double step = std::pow(10.0, std::floor(std::log10((high - low) / most)));
  for (const double factor : {2.0, 2.5, 2.0, 2.0}) {  // 1 -> 2 -> 5 -> 10 -> 20
    if (std::floor(high / step) - std::ceil(low / step) + 1 <= most) break;
    step *= factor;
  }
  std::vector<double> ticks;
  for (double i = std::ceil(low / step); i <= std::floor(high / step + 1e-9); ++i) ticks.push_back(i * step);
  return ticks;
}

std::string ValueAxis(const Plot& plot, int most_ticks) {
  std::string svg;
  for (const double value : RoundTicks(plot.low, plot.high, most_ticks)) {
    svg += fmt::format("<line class='grid' x1='{:.1f}' x2='{:.1f}' y1='{:.1f}' y2='{:.1f}'/>", plot.left,
                       plot.right(), plot.Y(value), plot.Y(value));
    svg += Label(plot.left - 8, plot.Y(value) + 4, fmt::format("{:.6g}", value), "tick", Anchor::kEnd);
  }
  return svg;
}

std::string Label(double x, double y, const std::string& text, const std::string& css_class, Anchor anchor) {
  constexpr std::array<const char*, 3> kAnchors = {"start", "middle", "end"};
  return fmt::format("<text class='{}' x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>", css_class, x, y,
                     kAnchors[static_cast<std::size_t>(anchor)], Escaped(text));
}

std::string Shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;  // not within a UTF-8 character
  return text.substr(0, end) + "\u2026";
}

}  // namespace elbowroom::sessions
