// What the program's --help says, read as a person reads it: what the manual and completion are held against.
#pragma once

#include <string>
#include <vector>

namespace elbowroom::test_support {

struct HelpEntry {
  std::vector<std::string> names;  // "-h", "--help"; a positional's or a command's name
  std::string description;
};

struct HelpPage {
  std::vector<std::string> path;  // {"trial", "run"}
  std::vector<HelpEntry> positionals, options, subcommands;
  std::vector<std::string> footer;  // lines below all that
};

// The page of the program, and those of all commands below it, each before its subcommands.
[[nodiscard]] std::vector<HelpPage> ReadHelpPages();

// "trial run"
[[nodiscard]] std::string PathText(const HelpPage& page);

}  // namespace elbowroom::test_support
