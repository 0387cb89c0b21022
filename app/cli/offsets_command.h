// The subcommand of `cameras` that measures time offsets.
#pragma once

#include "app/cli/options/command.h"

namespace elbowroom::cli {

// Adds `offsets` below `cameras`; when it is given, `*choice` is set.
void AddOffsetsCommand(CLI::App& cameras, Choice* choice);

}  // namespace elbowroom::cli
