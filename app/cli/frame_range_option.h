// --frames A:B: which frames of footage or of a session.
#pragma once

#include <CLI/CLI.hpp>

#include "app/control/trial_runner.h"

namespace elbowroom::cli {

// `range` outlives the parsing of the command line.
void AddFrameRangeOption(CLI::App& command, control::FrameRange* range);

}  // namespace elbowroom::cli
