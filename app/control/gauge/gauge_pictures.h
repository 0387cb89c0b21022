// The pictures of a gauge's page, as SVG.
#pragma once

#include <string>

#include "app/control/gauge/gauge_job.h"
#include "core/rig.h"

namespace elbowroom::control {

// The places in the workspace, from above and from the side: each rod as long as it was seen, coloured by the
// size of its diameter's error.
[[nodiscard]] std::string PlacesPicture(const core::Rig& rig, const GaugeOutcome& outcome);

// The diameter's error at each place, with its bound.
[[nodiscard]] std::string ErrorsPicture(const GaugeOutcome& outcome);

}  // namespace elbowroom::control
