#include "app/cli/reference/shell_words.h"

#include <algorithm>

namespace elbowroom::cli {

std::string ShellQuoted(std::string_view text) {
  std::string quoted = "'";
  for (const char character : text)
    quoted += character == '\'' ? std::string("'\\''") : std::string(1, character == '\n' ? ' ' : character);
  return quoted + '\'';
}

std::vector<ArgumentEntry> OptionsFor(const std::vector<CommandEntry>& table, const CommandEntry& command) {
  std::vector<ArgumentEntry> options = command.options;
  std::vector<std::string> path = command.path;
  while (!path.empty()) {
    path.pop_back();
    for (const ArgumentEntry& above : CommandAt(table, path).options) {
      const bool is_known = std::ranges::any_of(
          options, [&](const ArgumentEntry& option) { return option.names == above.names; });
      if (!is_known && above.names.back() != "--version") options.push_back(above);
    }
  }
  return options;
}

bool IsNumber(const ArgumentEntry& argument) {
  return argument.choices.empty() &&
         (argument.value.starts_with("INT") || argument.value.starts_with("UINT") ||
          argument.value.starts_with("FLOAT"));
}

}  // namespace elbowroom::cli
