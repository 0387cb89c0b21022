#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/reference/completion.h"
#include "app/cli/reference/shell_words.h"

namespace elbowroom::cli {
namespace {

// Finds the command, and hands the words behind it to _arguments.
constexpr std::string_view kFindCommand = R"(
  local at=''
  integer i last=1
  for ((i = 2; i < CURRENT; ++i)); do
    if ((${commands[(Ie)${at:+$at }${words[i]}]})); then
      at=${at:+$at }${words[i]}
      last=$i
    fi
  done
  shift $((last - 1)) words
  ((CURRENT -= last - 1))
  case $at in
)";

// Text inside of a specification of _arguments.
std::string ZshPlain(std::string_view text) {
  std::string plain;
  for (const char character : text) {
    if (std::string_view("[]:\\").find(character) != std::string_view::npos) plain += '\\';
    plain += character;
  }
  return plain;
}

// What completes a value: its choices, nothing for a number, files for all else.
std::string ActionOf(const ArgumentEntry& argument) {
  if (!argument.choices.empty()) return fmt::format("({})", fmt::join(argument.choices, " "));
  return IsNumber(argument) ? " " : "_files";
}

std::string OptionSpecifications(const ArgumentEntry& option) {
  std::string specifications;
  for (const std::string& name : option.names) {
    std::string one = fmt::format("{}{}[{}]", option.repeats ? "*" : "", name, ZshPlain(option.description));
    if (!option.value.empty()) one += fmt::format(":{}:{}", ZshPlain(option.value), ActionOf(option));
    specifications += " \\\n        " + ShellQuoted(one);
  }
  return specifications;
}

std::string ZshCase(const std::vector<CommandEntry>& table, const CommandEntry& command) {
  std::string subcommands, specifications;
  for (const std::string& name : command.subcommands) {
    std::vector<std::string> path = command.path;
    path.push_back(name);
    subcommands += " " + ShellQuoted(fmt::format("{}:{}", name, CommandAt(table, path).description));
  }
  for (const ArgumentEntry& option : OptionsFor(table, command))
    specifications += OptionSpecifications(option);
  if (!command.subcommands.empty()) {
    specifications += std::string(" \\\n        '*:command:{_describe command subcommands") +
                      (command.positionals.empty() ? "" : "; _files") + "}'";
  } else {
    for (const ArgumentEntry& argument : command.positionals)
      specifications +=
          " \\\n        " + ShellQuoted(fmt::format("{}:{}:{}", argument.repeats ? "*" : "",
                                                    argument.names.front(), ActionOf(argument)));
  }
  return fmt::format("    ({})\n      subcommands=({})\n      _arguments{}\n      ;;\n",
                     ShellQuoted(JoinedPath(command)), subcommands, specifications);
}

}  // namespace

std::string ZshCompletion(const std::vector<CommandEntry>& table) {
  std::string script =
      "#compdef elbowroom\n# Completion of elbowroom by zsh; the program wrote it.\n_elbowroom() {\n"
      "  local -a subcommands commands=(";
  for (const CommandEntry& command : table)
    if (!command.path.empty()) script += " " + ShellQuoted(JoinedPath(command));
  script.append(")").append(kFindCommand);
  for (const CommandEntry& command : table) script += ZshCase(table, command);
  return script + "  esac\n}\n_elbowroom \"$@\"\n";
}

}  // namespace elbowroom::cli
