#include "app/cli/reference/command_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace elbowroom::cli {
namespace {

constexpr const char* kProgram = "elbowroom";

bool IsShown(const CLI::Option* option) { return !option->get_group().empty(); }

// The values that CLI::IsMember allows; its description is "{a,b,c}".
std::vector<std::string> ChoicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

std::vector<std::string> NamesOf(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true, false)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

ArgumentEntry EntryOf(const CLI::Option& option) {
  const std::string value = CLI::Formatter().make_option_opts(&option);
  return {.names = NamesOf(option),
          .value = CLI::detail::trim_copy(value),
          .choices = ChoicesOf(option),
          .description = option.get_description(),
          .repeats = option.get_expected_max() > 1};
}

// What --help has behind "Usage:", where the command is called by `called`.
std::string UsageOf(const CLI::App& app, const std::string& called) {
  constexpr std::string_view kBefore = "Usage: ";
  const std::string usage = CLI::detail::trim_copy(CLI::Formatter().make_usage(&app, called));
  return usage.starts_with(kBefore) ? usage.substr(kBefore.size()) : usage;
}

// `called`: "elbowroom touches SESSION set", with what the commands above it take before it.
void AddCommands(const CLI::App& app, const std::string& called, const std::vector<std::string>& path,
                 std::vector<CommandEntry>* table) {
  CommandEntry command{.path = path,
                       .usage = UsageOf(app, called),
                       .description = app.get_description(),
                       .positionals = {},
                       .options = {},
                       .subcommands = {},
                       .footer = CLI::detail::trim_copy(app.get_footer())};
  for (const CLI::Option* option : app.get_options(IsShown))
    (option->get_positional() ? command.positionals : command.options).push_back(EntryOf(*option));
  std::vector<const CLI::App*> subcommands =
      app.get_subcommands([](const CLI::App* subcommand) { return !subcommand->get_group().empty(); });
  for (const CLI::App* subcommand : subcommands) command.subcommands.push_back(subcommand->get_name());
  std::string before = called;
  for (const ArgumentEntry& positional : command.positionals) before += " " + positional.names.front();
  table->push_back(std::move(command));
  for (const CLI::App* subcommand : subcommands) {
    std::vector<std::string> below = path;
    below.push_back(subcommand->get_name());
    AddCommands(*subcommand, fmt::format("{} {}", before, subcommand->get_name()), below, table);
  }
}

}  // namespace

std::vector<CommandEntry> CommandTable(const CLI::App& app) {
  std::vector<CommandEntry> table;
  AddCommands(app, kProgram, {}, &table);
  return table;
}

std::string JoinedPath(const CommandEntry& command) {
  return fmt::format("{}", fmt::join(command.path, " "));
}

const CommandEntry& CommandAt(const std::vector<CommandEntry>& table, const std::vector<std::string>& path) {
  const auto found = std::ranges::find(table, path, &CommandEntry::path);
  core::Require(found != table.end(), "the command is in the table");
  return *found;
}

}  // namespace elbowroom::cli
