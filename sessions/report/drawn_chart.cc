#include "sessions/report/drawn_chart.h"

#include <future>
#include <string>
#include <utility>

namespace elbowroom::sessions {

DrawnChart Drawn(Chart chart, ChartPainters* painters) {
  constexpr double kPaperWidthPx = 880.0;
  std::future<std::string> paper =
      std::async(std::launch::async, [&] { return painters->paper.Svg(chart, kPaperWidthPx); });
  std::string svg = painters->screen.Svg(chart), paper_svg = paper.get();
  return {std::move(chart), std::move(svg), std::move(paper_svg)};
}

}  // namespace elbowroom::sessions
