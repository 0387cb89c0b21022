// The paper's curtain.
#pragma once

#include "core/layout.h"

namespace elbowroom::review {

// A panel of 2 * across * down triangles in the x-z plane, its upper edge at z = 0 and pinned, its middle at
// x = 0; the paper's curtain by default.
[[nodiscard]] core::Part Curtain(int across = 20, int down = 18, double width_mm = 400.0,
                                 double height_mm = 360.0);

}  // namespace elbowroom::review
