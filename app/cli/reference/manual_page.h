// The manual page of the program, elbowroom(1).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/cli/reference/command_table.h"

namespace elbowroom::cli {

// The page in the language of man(7), as UTF-8: a section for each command with all that its --help says.
[[nodiscard]] std::string ManualPage(const std::vector<CommandEntry>& table, std::string_view version);

}  // namespace elbowroom::cli
