#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/reference/completion.h"
#include "app/cli/reference/shell_words.h"

namespace elbowroom::cli {
namespace {

// True where the words before the cursor choose the command "$argv[1]".
constexpr std::string_view kFishAt = R"(
function __elbowroom_at
    set -l words (commandline -opc)
    set -l at ''
    for word in $words[2..-1]
        if contains -- (string trim -- "$at $word") $__elbowroom_commands
            set at (string trim -- "$at $word")
        end
    end
    test "$at" = "$argv[1]"
end
)";

// In fish's single quotes, \ and ' have a \ before them.
std::string FishQuoted(std::string_view text) {
  std::string quoted = "'";
  for (const char character : text) {
    if (character == '\'' || character == '\\') quoted += '\\';
    quoted += character == '\n' ? ' ' : character;
  }
  return quoted + '\'';
}

std::string FishLine(const CommandEntry& command, const std::string& what) {
  return fmt::format("complete -c elbowroom -n {} {}\n",
                     FishQuoted(fmt::format("__elbowroom_at \"{}\"", JoinedPath(command))), what);
}

std::string FishOption(const ArgumentEntry& option) {
  std::string text;
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.choices.empty()) {
    text += " -x -a " + FishQuoted(fmt::format("{}", fmt::join(option.choices, " ")));
  } else if (!option.value.empty()) {
    text += IsNumber(option) ? " -x" : " -r -F";
  }
  return text.substr(1) + " -d " + FishQuoted(option.description);
}

std::string FishLines(const std::vector<CommandEntry>& table, const CommandEntry& command) {
  std::string lines;
  for (const std::string& name : command.subcommands) {
    std::vector<std::string> path = command.path;
    path.push_back(name);
    lines += FishLine(command, fmt::format("{}-a {} -d {}", command.positionals.empty() ? "-f " : "", name,
                                           FishQuoted(CommandAt(table, path).description)));
  }
  for (const ArgumentEntry& argument : command.positionals)
    if (!argument.choices.empty())
      lines += FishLine(command, fmt::format("-f -a {} -d {}",
                                             FishQuoted(fmt::format("{}", fmt::join(argument.choices, " "))),
                                             FishQuoted(argument.description)));
  for (const ArgumentEntry& option : OptionsFor(table, command))
    lines += FishLine(command, FishOption(option));
  return lines;
}

}  // namespace

std::string FishCompletion(const std::vector<CommandEntry>& table) {
  std::string script =
      "# Completion of elbowroom by fish; the program wrote it.\nset -g __elbowroom_commands";
  for (const CommandEntry& command : table)
    if (!command.path.empty()) script += " " + FishQuoted(JoinedPath(command));
  script.append("\n").append(kFishAt);
  for (const CommandEntry& command : table) script += FishLines(table, command);
  return script;
}

}  // namespace elbowroom::cli
