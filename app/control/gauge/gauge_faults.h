// Why a place of a gauge doesn't pass, in plain lines.
#pragma once

#include <string>
#include <vector>

#include "app/control/gauge/gauge_job.h"

namespace elbowroom::control {

// `place` has all but its faults. None: each measured figure is within its bound of the true one, and all
// cameras agree.
[[nodiscard]] std::vector<std::string> FaultsOf(const GaugePlace& place, const TrueRod& truth);

}  // namespace elbowroom::control
