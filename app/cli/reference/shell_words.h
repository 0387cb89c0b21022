// What the scripts of all shells are made of.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/cli/reference/command_table.h"

namespace elbowroom::cli {

// 'it'\''s': one word to bash and zsh, whatever is in it.
[[nodiscard]] std::string ShellQuoted(std::string_view text);

// Options that may stand behind a command: its own, and those of the commands above it and of the program.
[[nodiscard]] std::vector<ArgumentEntry> OptionsFor(const std::vector<CommandEntry>& table,
                                                    const CommandEntry& command);

// True of an argument that takes an integer or a decimal number.
[[nodiscard]] bool IsNumber(const ArgumentEntry& argument);

}  // namespace elbowroom::cli
