// The colours of a quantity from little to much, the same in pictures, reports and the 3-D view.
#pragma once

#include "app/control/palette/part_colors.h"

namespace elbowroom::control {

// sessions::DepthColour: from pale orange (0) to dark red (1), evenly darker also for those who can't see
// red, green or blue (palette_test). `share` is kept within [0, 1].
[[nodiscard]] Color ScaleColor(double share);

}  // namespace elbowroom::control
