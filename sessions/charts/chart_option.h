// A chart as the plotting library takes it.
#pragma once

#include <string>

#include "sessions/charts/chart.h"

namespace elbowroom::sessions {

// The chart's height in px at any width.
[[nodiscard]] double HeightOf(const Chart& chart);

// An option of Apache ECharts, as JSON in ASCII without "<". Where it says "@NAME", a function of
// web/charts/named_functions.js belongs. Numbers that aren't finite, and bytes that are no UTF-8, don't come
// through: null, U+FFFD.
[[nodiscard]] std::string OptionJson(const Chart& chart);

}  // namespace elbowroom::sessions
