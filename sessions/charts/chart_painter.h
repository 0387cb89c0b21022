// Charts as pictures.
#pragma once

#include <memory>
#include <string>

#include "sessions/charts/chart.h"

namespace elbowroom::sessions {

// Draws charts with Apache ECharts, which runs in Duktape. Making one takes a tenth of a second: it reads the
// library's program. Thread: one at a time.
class ChartPainter {
 public:
  ChartPainter();
  ~ChartPainter();
  ChartPainter(ChartPainter&&) noexcept;
  ChartPainter& operator=(ChartPainter&&) noexcept;

  // <svg> of `width_px`, HeightOf(chart) high, with real text; its colours are names (ColorOf). The same
  // chart gives the same text. Throws: PreconditionError for an x axis without length.
  [[nodiscard]] std::string Svg(const Chart& chart, double width_px = 1040.0);

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace elbowroom::sessions
