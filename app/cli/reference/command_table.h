// The command line as a table: what --help says, for what else tells of it (the manual, shell completion).
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace elbowroom::cli {

// An option, a flag, or a positional argument.
struct ArgumentEntry {
  std::vector<std::string> names;    // "-h", "--help"; a positional's one name: "SESSION"
  std::string value;                 // as --help has it: "TEXT REQUIRED"; empty: a flag
  std::vector<std::string> choices;  // empty: any value
  std::string description;
  bool repeats = false;  // takes several values
};

struct CommandEntry {
  std::vector<std::string> path;  // {"trial", "run"}; empty: the program itself
  std::string usage;              // "elbowroom trial run [OPTIONS] TRIAL"
  std::string description;
  std::vector<ArgumentEntry> positionals, options;
  std::vector<std::string> subcommands;
  std::string footer;  // lines below all that; may be empty
};

// The program first, then each command before its subcommands, in the order of --help. Hidden ones are left
// out.
[[nodiscard]] std::vector<CommandEntry> CommandTable(const CLI::App& app);

// "trial run"
[[nodiscard]] std::string JoinedPath(const CommandEntry& command);

// The command of the table with this path. Throws: PreconditionError where there is none.
[[nodiscard]] const CommandEntry& CommandAt(const std::vector<CommandEntry>& table,
                                            const std::vector<std::string>& path);

}  // namespace elbowroom::cli
