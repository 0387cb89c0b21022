#include "tests/app/installed/help_pages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <stdexcept>

#include "tests/support/places.h"
#include "tests/support/run_program.h"

namespace elbowroom::test_support {
namespace {

// Names begin in the third column, descriptions in the 31st, of the same line or the next.
constexpr std::size_t kNameColumn = 2, kDescriptionColumn = 30;

std::vector<std::string> NamesIn(const std::string& line) {
  std::vector<std::string> names;
  std::istringstream words(line);
  std::string word, name;
  words >> word;
  std::istringstream list(word);
  while (std::getline(list, name, ','))
    names.push_back(name.substr(0, name.find('{')));  // "--no-next{false}"
  return names;
}

void ReadLine(const std::string& line, std::vector<HelpEntry>* entries) {
  const bool is_name = line.size() > kNameColumn && line.find_first_not_of(' ') == kNameColumn;
  if (is_name) entries->push_back({NamesIn(line), ""});
  if (line.size() <= kDescriptionColumn || entries->empty()) return;
  // Where a name reaches so far, the next line has the description.
  const bool is_below_name = line.find_first_not_of(' ') == kDescriptionColumn;
  const bool is_behind_name = is_name && line[kDescriptionColumn - 1] == ' ';
  if (is_behind_name || is_below_name) entries->back().description = line.substr(kDescriptionColumn);
}

HelpPage ReadHelpPage(const std::vector<std::string>& path, std::vector<std::string> arguments) {
  arguments.emplace_back("--help");
  const ProgramRun run = RunProgram(test_support::ProgramFile(), arguments);
  if (run.exit_status != 0) throw std::runtime_error(run.err);
  HelpPage page{.path = path, .positionals = {}, .options = {}, .subcommands = {}, .footer = {}};
  std::vector<HelpEntry>* section = nullptr;
  std::istringstream lines(run.out);
  for (std::string line; std::getline(lines, line);) {
    if (line == "Positionals:") {
      section = &page.positionals;
    } else if (line == "Options:") {
      section = &page.options;
    } else if (line == "Subcommands:") {
      section = &page.subcommands;
    } else if (section == nullptr) {
      continue;
    } else if (!page.footer.empty() || (!line.empty() && line.front() != ' ')) {
      page.footer.push_back(line);
    } else {
      ReadLine(line, section);
    }
  }
  return page;
}

// `words` choose the command: its path, with something for each positional before a subcommand.
void AddPages(const std::vector<std::string>& path, std::vector<std::string> words,
              std::vector<HelpPage>* pages) {
  pages->push_back(ReadHelpPage(path, words));
  words.insert(words.end(), pages->back().positionals.size(), "S.db");
  const std::vector<HelpEntry> subcommands = pages->back().subcommands;
  for (const HelpEntry& subcommand : subcommands) {
    std::vector<std::string> below = path;
    below.push_back(subcommand.names.front());
    std::vector<std::string> words_below = words;
    words_below.push_back(below.back());
    AddPages(below, words_below, pages);
  }
}

}  // namespace

std::vector<HelpPage> ReadHelpPages() {
  std::vector<HelpPage> pages;
  AddPages({}, {}, &pages);
  return pages;
}

std::string PathText(const HelpPage& page) { return fmt::format("{}", fmt::join(page.path, " ")); }

}  // namespace elbowroom::test_support
