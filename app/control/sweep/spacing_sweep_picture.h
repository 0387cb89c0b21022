// A spacing study as a chart: frames in contact and least clearance over the spacing.
#pragma once

#include <string>

#include "app/control/line_drawing.h"
#include "core/session.h"
#include "review/spacing_study.h"

namespace elbowroom::control {

// Shows the parts that the spacing moves: above, in how many frames each is in contact; below, the bounds of
// its least clearance, as a band. Marks the smallest spacing without contact and the trial's estimate.
[[nodiscard]] LineDrawing SpacingSweepPicture(const core::SessionHeader& header, const std::string& spacing,
                                              const review::SpacingStudy& study);

}  // namespace elbowroom::control
