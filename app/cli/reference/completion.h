// Completion of the command line by shells, from the same table as the manual.
#pragma once

#include <string>
#include <vector>

#include "app/cli/reference/command_table.h"

namespace elbowroom::cli {

// Scripts that a shell loads on the first Tab after "elbowroom ". They complete commands, options and the
// values that --help lists; numbers get nothing, any other value file names.
[[nodiscard]] std::string BashCompletion(const std::vector<CommandEntry>& table);
[[nodiscard]] std::string ZshCompletion(const std::vector<CommandEntry>& table);
[[nodiscard]] std::string FishCompletion(const std::vector<CommandEntry>& table);

}  // namespace elbowroom::cli
