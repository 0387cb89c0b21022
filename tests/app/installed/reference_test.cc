// The manual and the completion of shells say what --help says: the manual as man(1) reads it, completion in
// real shells.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/installed/help_pages.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom {
namespace {

using test_support::HelpEntry;
using test_support::HelpPage;
using test_support::ProgramRun;
using test_support::RunProgram;
using Words = std::set<std::string>;

constexpr std::size_t kFewestCommands = 40;  // or --help is read wrongly

const std::vector<HelpPage>& Help() {
  static const std::vector<HelpPage> pages = test_support::ReadHelpPages();
  return pages;
}

std::string Reference(const std::string& form) {
  const ProgramRun run = RunProgram(test_support::ProgramFile(), {"reference", form});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  return run.out;
}

void AddOptions(const HelpPage& page, Words* words) {
  for (const HelpEntry& option : page.options)
    for (const std::string& name : option.names) words->insert(name);
}

// Options of a command and of those above it; --version is the program's alone.
Words OptionsBehind(const HelpPage& page) {
  Words words;
  for (const HelpPage& other : Help()) {
    const bool is_above = other.path.size() <= page.path.size() &&
                          std::equal(other.path.begin(), other.path.end(), page.path.begin());
    if (is_above) AddOptions(other, &words);
  }
  if (!page.path.empty()) words.erase("--version");
  return words;
}

// The text of the manual as a reader sees it.
std::string WithoutEscapes(std::string roff) {
  for (const auto& [escape, text] : {std::pair("\\-", "-"), std::pair("\\(aq", "'"), std::pair("\\(dq", "\""),
                                     std::pair("\\e", "\\"), std::pair("\\&", "")})
    for (std::size_t at = 0; (at = roff.find(escape, at)) != std::string::npos;)
      roff.replace(at, std::string(escape).size(), text);
  return roff;
}

TEST(Manual, HasEachCommandAndOptionOfHelpWithItsDescription) {
  const std::string manual = WithoutEscapes(Reference("man"));
  ASSERT_GT(Help().size(), kFewestCommands);
  for (const HelpPage& page : Help()) {
    const std::string path = test_support::PathText(page);
    const std::string title = path.empty() ? "\n.SH OPTIONS\n" : "\n.SS \"" + path + "\"\n";
    const std::size_t begin = manual.find(title);
    ASSERT_NE(begin, std::string::npos) << path;
    const std::size_t end = manual.find("\n.S", begin + title.size());
    const std::string section = manual.substr(begin, end - begin) + "\n";
    std::vector<HelpEntry> entries = page.options;
    entries.insert(entries.end(), page.positionals.begin(), page.positionals.end());
    for (const HelpEntry& entry : entries) {
      EXPECT_THAT(section, testing::HasSubstr(fmt::format("\n\\fB{}\\fR", fmt::join(entry.names, ", "))))
          << path;
      EXPECT_FALSE(entry.description.empty()) << path << " " << entry.names.front();
      EXPECT_THAT(section, testing::HasSubstr("\n" + entry.description + "\n")) << path;
    }
    for (const std::string& line : page.footer)
      EXPECT_THAT(section, testing::HasSubstr("\n" + line + "\n")) << path;
  }
}

TEST(Manual, IsReadWithoutAWarning) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "elbowroom.1", Reference("man"));
  const ProgramRun run = RunProgram(
      "/usr/bin/man",
      {"--warnings", "--encoding=UTF-8", "--local-file", "--pager=cat", (folder / "elbowroom.1").string()},
      {.environment = {{"LC_ALL", "C.UTF-8"}, {"MANWIDTH", "80"}}});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, testing::HasSubstr("elbowroom trial run [OPTIONS] TRIAL"));
}

// Asks bash what follows each line of words, of which the last is the one that is being written.
std::map<std::string, Words> AskBash(const std::vector<std::vector<std::string>>& lines) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "completion", Reference("bash"));
  std::string asking = "set -u\nsource '" + (folder / "completion").string() + "'\n";
  for (const std::vector<std::string>& words : lines)
    asking += fmt::format(
        "COMP_WORDS=(elbowroom '{0}')\nCOMP_CWORD={1}\nCOMPREPLY=()\n_elbowroom\n"
        "for word in \"${{COMPREPLY[@]}}\"; do printf '%s\\t%s\\n' '{2}' \"$word\"; done\n",
        fmt::join(words, "' '"), words.size(), fmt::join(words, " "));
  test_support::WriteText(folder / "asking", asking);
  const ProgramRun run = RunProgram("/bin/bash", {"--norc", "--noprofile", (folder / "asking").string()});
  EXPECT_EQ(run.err, "");
  std::map<std::string, Words> answers;
  std::istringstream said(run.out);
  for (std::string line, word; std::getline(said, line, '\t') && std::getline(said, word);)
    answers[line].insert(word);
  return answers;
}

std::vector<std::string> Behind(std::vector<std::string> path, const std::string& word) {
  path.push_back(word);
  return path;
}

TEST(BashCompletion, KnowsEachCommandAndOptionOfHelp) {
  std::vector<std::vector<std::string>> lines;
  for (const HelpPage& page : Help()) {
    lines.push_back(Behind(page.path, "-"));
    lines.push_back(Behind(page.path, ""));
  }
  const std::map<std::string, Words> answers = AskBash(lines);
  const auto answer = [&](const std::vector<std::string>& words) {
    const auto found = answers.find(fmt::format("{}", fmt::join(words, " ")));
    return found == answers.end() ? Words() : found->second;
  };
  ASSERT_GT(Help().size(), kFewestCommands);
  for (const HelpPage& page : Help()) {
    EXPECT_EQ(answer(Behind(page.path, "-")), OptionsBehind(page)) << test_support::PathText(page);
    Words subcommands;
    for (const HelpEntry& subcommand : page.subcommands) subcommands.insert(subcommand.names.front());
    if (subcommands.empty()) continue;
    EXPECT_EQ(answer(Behind(page.path, "")), subcommands) << test_support::PathText(page);
  }
}

TEST(BashCompletion, KnowsValuesAndTakesThemForNothingElse) {
  auto answers = AskBash({{"touches", "S.db", "--status", ""},
                          {"touches", "S.db", "--status", "=", "ac"},
                          {"touches", "S.db", "--status", "="},
                          {"board", ""},
                          {"trial", "run", "--session", ""},
                          {"--threads", ""},
                          {"demo", "--out", "trial", "--he"}});
  const Words statuses{"new", "active", "reviewed", "approved", "resolved"};
  EXPECT_EQ(answers["touches S.db --status "], statuses);
  EXPECT_EQ(answers["touches S.db --status = ac"], Words{"active"});
  EXPECT_EQ(answers["touches S.db --status ="], statuses);
  EXPECT_EQ(answers["board "].count("charuco"), 1U);
  EXPECT_EQ(answers["trial run --session "], Words());  // so bash completes files
  EXPECT_EQ(answers["--threads "], Words());
  EXPECT_EQ(answers["demo --out trial --he"], (Words{"--headless", "--help"}));
}

TEST(FishCompletion, KnowsEachCommandAndOptionOfHelp) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "completion", Reference("fish"));
  std::string asking = "source '" + (folder / "completion").string() + "'\n";
  for (const HelpPage& page : Help()) {
    const std::string path = page.path.empty() ? "" : test_support::PathText(page) + " ";
    for (const std::string word : {"--", ""})
      asking +=
          fmt::format("for line in (complete -C 'elbowroom {0}{1}')\necho -e \"{2} {1}\\t$line\"\nend\n",
                      path, word, test_support::PathText(page));
  }
  const ProgramRun run = RunProgram("/usr/bin/fish", {"--no-config", "-c", asking},
                                    {.environment = {{"HOME", folder.path().string()}}});
  EXPECT_EQ(run.err, "");
  for (const HelpPage& page : Help()) {
    const std::string path = test_support::PathText(page);
    for (const std::string& option : OptionsBehind(page))
      if (option.starts_with("--")) {
        EXPECT_THAT(run.out, testing::HasSubstr(fmt::format("{} --\t{}\t", path, option)));
      }
    for (const HelpEntry& subcommand : page.subcommands)
      EXPECT_THAT(run.out, testing::HasSubstr(fmt::format("{} \t{}\t{}", path, subcommand.names.front(),
                                                          subcommand.description)));
  }
}

// A zsh at a pseudo-terminal, as at a person's: it reads until the prompt is there, then until the last
// option is.
constexpr const char* kAskZsh = R"(
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PROMPT=; autoload -Uz compinit; compinit -u -D; source $1 2>/dev/null; compdef _elbowroom elbowroom; LISTMAX=999; print is-${:-ready}"
zpty -r shell said '*is-ready*'
zpty -w -n shell "elbowroom trial run --"$'\t\t'
zpty -r shell said '*--threads *'
print -r -- $said
zpty -d shell
)";

TEST(ZshCompletion, ListsOptionsOfACommand) {
  const test_support::TemporaryFolder folder;
  test_support::WriteText(folder / "_elbowroom", Reference("zsh"));
  test_support::WriteText(folder / "asking", kAskZsh);
  const ProgramRun run =
      RunProgram("/usr/bin/zsh", {"-f", (folder / "asking").string(), (folder / "_elbowroom").string()},
                 {.environment = {{"TERM", "xterm"}, {"LC_ALL", "C.UTF-8"}}, .timeout_s = 60.0});
  for (const std::string option : {"--session", "--headless", "--frames", "--json", "--help"})
    EXPECT_THAT(run.out, testing::HasSubstr(option + " "));
  EXPECT_THAT(run.out, testing::HasSubstr("no window, as fast as it goes"));
}

TEST(HiddenCommands, AreInNoListing) {
  const std::string manual = Reference("man"), fish = Reference("fish");
  for (const std::string name : {"reference", "open"}) {
    EXPECT_EQ(manual.find(".SS \"" + name), std::string::npos);
    EXPECT_EQ(fish.find(" -a " + name + " "), std::string::npos);
    for (const HelpEntry& command : Help().front().subcommands) EXPECT_NE(command.names.front(), name);
  }
}

}  // namespace
}  // namespace elbowroom
