// A sweep as a chart: frames in contact and least clearance over the spacing.
#pragma once

#include <string>

#include "app/control/line_drawing.h"
#include "app/control/sweep/spacing_sweep.h"

namespace elbowroom::control {

// Shows the parts that the spacing moves: above, in how many frames each is in contact (of several sessions,
// in how many per cent: each session thin, all together thick); below, the bounds of its least clearance over
// all frames, as a band (of several sessions, the upper bound of each, thin). Marks the smallest spacing
// without contact and with the required clearance, and the participants' estimates.
[[nodiscard]] LineDrawing SpacingSweepPicture(const SpacingSweep& sweep, const std::string& spacing);

}  // namespace elbowroom::control
