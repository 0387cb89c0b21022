// A curtain for a table's size.
#pragma once

#include "core/layout.h"

namespace elbowroom::review {

// A panel of 2 * across * down triangles in the x-z plane, its upper edge at z = 0 and pinned, its middle at
// x = 0. By default it has as many triangles as the paper's curtain, 720, in squares of 20 mm; the paper's
// were 75 x 30 mm each (tests/accuracy/curtain_scene.h).
[[nodiscard]] core::Part Curtain(int across = 20, int down = 18, double width_mm = 400.0,
                                 double height_mm = 360.0);

}  // namespace elbowroom::review
