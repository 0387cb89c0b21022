// Charts of a document, drawn for the screen and for paper.
#pragma once

#include "sessions/charts/chart_painter.h"
#include "sessions/document/document.h"

namespace elbowroom::sessions {

// One for each size of a chart, so that both sizes are drawn at once.
struct ChartPainters {
  ChartPainter screen;
  ChartPainter paper;
};

// Throws: as ChartPainter::Svg. Thread: one at a time.
[[nodiscard]] DrawnChart Drawn(Chart chart, ChartPainters* painters);

}  // namespace elbowroom::sessions
