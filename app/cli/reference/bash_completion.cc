#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/reference/completion.h"
#include "app/cli/reference/shell_words.h"

namespace elbowroom::cli {
namespace {

// Before it stands _elbowroom_command, which sets what a command takes, and _elbowroom_choices. Bash makes
// words of their own of the = in "--spacing=a"; it falls back to file names where COMPREPLY stays empty.
constexpr std::string_view kBashFunction = R"(
_elbowroom() {
  local subcommands options valued numbers positional at='' previous='' word choices
  local current=${COMP_WORDS[COMP_CWORD]} i
  _elbowroom_command ''
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    [[ $word != '=' ]] || continue
    if [[ -n $previous && " $valued " == *" $previous "* ]]; then
      previous=''
      continue
    fi
    previous=$word
    if [[ " $subcommands " == *" $word "* ]]; then
      at=${at:+$at }$word
      _elbowroom_command "$at"
    fi
  done
  [[ $current != '=' ]] || current=''
  COMPREPLY=()
  if [[ -n $previous && " $valued " == *" $previous "* ]]; then
    choices=''
    _elbowroom_choices "$at" "$previous"
    if [[ -n $choices ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
    elif [[ " $numbers " == *" $previous "* ]]; then
      compopt +o default +o bashdefault 2>/dev/null
    fi
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -W "$subcommands $positional" -- "$current")
  fi
}
complete -o default -o bashdefault -F _elbowroom elbowroom
)";

std::string BashCase(const std::vector<CommandEntry>& table, const CommandEntry& command) {
  std::vector<std::string> options, valued, numbers, positional;
  for (const ArgumentEntry& option : OptionsFor(table, command)) {
    for (const std::string& name : option.names) {
      options.push_back(name);
      if (!option.value.empty()) valued.push_back(name);
      if (IsNumber(option)) numbers.push_back(name);
    }
  }
  for (const ArgumentEntry& argument : command.positionals)
    positional.insert(positional.end(), argument.choices.begin(), argument.choices.end());
  const auto words = [](const std::vector<std::string>& list) {
    return ShellQuoted(fmt::format("{}", fmt::join(list, " ")));
  };
  return fmt::format(
      "    {})\n      subcommands={}\n      options={}\n      valued={}\n      numbers={}\n"
      "      positional={}\n      ;;\n",
      ShellQuoted(JoinedPath(command)), words(command.subcommands), words(options), words(valued),
      words(numbers), words(positional));
}

std::string BashChoices(const std::vector<CommandEntry>& table, const CommandEntry& command) {
  std::string cases;
  for (const ArgumentEntry& option : OptionsFor(table, command))
    for (const std::string& name : option.names)
      if (!option.choices.empty())
        cases += fmt::format("    {}) choices={} ;;\n", ShellQuoted(JoinedPath(command) + " " + name),
                             ShellQuoted(fmt::format("{}", fmt::join(option.choices, " "))));
  return cases;
}

}  // namespace

std::string BashCompletion(const std::vector<CommandEntry>& table) {
  std::string script =
      "# Completion of elbowroom by bash; the program wrote it.\n_elbowroom_command() {\n  case $1 in\n";
  for (const CommandEntry& command : table) script += BashCase(table, command);
  script += "  esac\n}\n_elbowroom_choices() {\n  case \"$1 $2\" in\n";
  for (const CommandEntry& command : table) script += BashChoices(table, command);
  return script.append("  esac\n}\n").append(kBashFunction);
}

}  // namespace elbowroom::cli
