// The options that say which way a part may give way.
#pragma once

#include <CLI/CLI.hpp>

#include "core/recovery_rule.h"

namespace elbowroom::cli {

// --recovery, --axis, --at, --reference
void AddRecoveryOptions(CLI::App& command, core::RecoveryRule* rule);

// For the command's callback. Throws: CLI::ValidationError where the options don't go together.
void CheckRecoveryOptions(const core::RecoveryRule& rule);

}  // namespace elbowroom::cli
