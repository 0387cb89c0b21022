// A wait that is told of.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "core/progress.h"

namespace elbowroom::control {

// Returns once `seconds` have passed (nothing: never), once `is_done` says so, or on a stop. `is_done` is
// called about every 100 ms, and a last time at the end of the seconds. `what` begins the progress, which
// counts whole seconds: "recording, second". Thread: the caller's.
void WaitSeconds(const std::optional<double>& seconds, const std::string& what,
                 const core::Progress& progress, const std::stop_token& stop,
                 const std::function<bool()>& is_done);

}  // namespace elbowroom::control
