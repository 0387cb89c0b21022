// The colours of charts.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sessions/charts/chart.h"

namespace elbowroom::sessions {

// "var(--spacing)": a page's style sheet says what that is in light and in dark.
[[nodiscard]] std::string ColorOf(Ink ink);

// The declarations of all inks for a style sheet: "--ink: #1d2733; ...".
[[nodiscard]] std::string LightInks();
[[nodiscard]] std::string DarkInks();

// What ColorOf gives, and the colour that is in light: {"var(--ink)", "#1d2733"}, ...
[[nodiscard]] std::vector<std::pair<std::string, std::string>> InksOnPaper();

// "#rrggbb" from pale (0) to dark red (1). The lightness changes evenly, so that a grey print shows it too.
[[nodiscard]] std::string DepthColour(double fraction);

}  // namespace elbowroom::sessions
