// --frames A:B of commands that go over frames.
#pragma once

#include <CLI/CLI.hpp>

#include "app/control/trial_runner.h"

namespace elbowroom::cli {

// "A:B", "A:" or ":B", A below B, which isn't included. `range` must live as long as the command is parsed.
void AddFrameRangeOption(CLI::App& command, control::FrameRange* range);

}  // namespace elbowroom::cli
