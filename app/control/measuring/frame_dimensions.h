// What a frame says in millimetres, at the place: clearances, depths, pairs.
#pragma once

#include <vector>

#include "app/control/frame_result.h"
#include "app/control/measuring/dimension.h"

namespace elbowroom::control {

// For each part that isn't in contact the line between the witness points of its clearance, with the interval
// that holds it, where the search has both bounds; for each part in contact the deepest point, with the lower
// bound of its depth; for each pair rule that is judged and whose parts' gap is known, that gap. Colours are
// those of the verdicts.
[[nodiscard]] std::vector<Dimension> DimensionsOf(const FrameResult& result);

// "12.3 – 14.1 mm": rounded outwards, to a tenth.
[[nodiscard]] std::string IntervalText(double lower_mm, double upper_mm);

}  // namespace elbowroom::control
