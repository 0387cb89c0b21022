#include "sessions/report/page_charts.h"

#include <fmt/format.h>

#include "sessions/charts/chart_option.h"
#include "sessions/report/markup.h"

namespace elbowroom::sessions {

std::string PageCharts::Add(const DrawnChart& drawn) {
  const Chart& chart = drawn.chart;
  const std::string id = fmt::format("chart-{}", count_++);
  json_ += fmt::format(R"({}{{"id":"{}","height":{},"option":{}}})", json_.empty() ? "" : ",", id,
                       HeightOf(chart), OptionJson(chart));
  return fmt::format("<figure class='chart' id='{}' role='img' aria-label='{}'>{}</figure>\n", id,
                     Escaped(chart.title), drawn.svg);
}

}  // namespace elbowroom::sessions
