// The files of a sweep: sweep.csv, sweep.svg and sweep.png.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/control/sweep/spacing_sweep.h"

namespace elbowroom::control {

// The smallest step at which, as at all above, the required clearance is sure in all frames of all sessions.
// Nothing: there is none, or one of the sessions required none.
[[nodiscard]] std::optional<double> SmallestWithClearanceMm(const SpacingSweep& sweep,
                                                            const review::SpacingCurve& curve);
[[nodiscard]] std::optional<double> SmallestWithClearanceMm(const SpacingSweep& sweep,
                                                            const SweptSession& session,
                                                            const review::SpacingCurve& curve);

// A line for each part at each step, of several sessions beginning with the session's path; and the picture.
// In `folder`, which is made if it isn't there; all or none. Throws: core::Error{kFile}.
[[nodiscard]] std::vector<std::filesystem::path> WriteSpacingSweep(const SpacingRange& range,
                                                                   const SpacingSweep& sweep,
                                                                   const std::filesystem::path& folder);

}  // namespace elbowroom::control
