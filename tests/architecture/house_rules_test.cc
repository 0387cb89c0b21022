// Sizes and documents keep up with the tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/architecture/layer_checker.h"
#include "tests/architecture/layers_file.h"
#include "tests/support/places.h"
#include "tests/support/text_file.h"

namespace elbowroom::architecture {
namespace {

namespace fs = std::filesystem;
using test_support::ReadText;

const fs::path kHouse = test_support::SourceFolder();

// CONTRIBUTING.md, "Sizes": beyond these a file holds more than one thing.
constexpr long kLongestSource = 600;
constexpr long kLongestHeader = 250;
constexpr int kMostFilesInAFolder = 60;  // thirty units

// First column of the table under "## Rooms".
std::set<std::string> RoomsInDocument(const fs::path& file) {
  std::istringstream stream(ReadText(file));
  const std::regex row(R"(^\| `([^`]+)` \|.*)");
  std::set<std::string> rooms;
  std::smatch match;
  bool in_section = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("## ")) in_section = line == "## Rooms";
    if (in_section && std::regex_match(line, match, row)) rooms.insert(match[1]);
  }
  return rooms;
}

TEST(HouseRules, NoFileIsTooLong) {
  for (const std::string& file : SourceFilesOf(kHouse)) {
    const std::string text = ReadText(kHouse / file);
    const long lines = std::ranges::count(text, '\n');
    EXPECT_LE(lines, file.ends_with(".h") ? kLongestHeader : kLongestSource) << file << ": split it";
  }
}

TEST(HouseRules, NoFolderHoldsTooManyFiles) {
  std::map<std::string, int> files_in;
  for (const std::string& file : SourceFilesOf(kHouse)) ++files_in[fs::path(file).parent_path().string()];
  for (const auto& [folder, files] : files_in)
    EXPECT_LE(files, kMostFilesInAFolder) << folder << ": make rooms inside it";
}

// Finds one of some words, "A|B".
std::regex AnyWordOf(const std::string& words) {
  return std::regex(std::string(R"(\b()").append(words).append(R"()\b)"));
}

// Paths and, after a path and a colon, the names that the file is said to have.
TEST(HouseRules, WhereDoINamesWhatIsThere) {
  const std::string page = ReadText(kHouse / "docs/where_do_i.md");
  const std::regex place(R"(`([a-z_0-9]+(?:/[A-Za-z_0-9.]+)+)`(: `\w+`(?:, `\w+`)*)?)"), name(R"(`(\w+)`)");
  int names = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), place), end; at != end; ++at) {
    const fs::path path = kHouse / (*at)[1].str();
    EXPECT_TRUE(fs::exists(path)) << (*at)[1] << " isn't there";
    if (!fs::is_regular_file(path)) continue;
    const std::string text = ReadText(path), said = (*at)[2];
    for (std::sregex_iterator word(said.begin(), said.end(), name); word != end; ++word, ++names) {
      EXPECT_TRUE(std::regex_search(text, AnyWordOf((*word)[1]))) << (*at)[1] << " has no " << (*word)[1];
    }
  }
  EXPECT_GT(names, 80) << "or the page is read wrongly";
}

// "| is done? | `a/file.h`: `Name` | `a/caller.cc` |": a caller's file has one of the names, where it stands
// alone.
// The bodies of all functions of that name in a source file; the whole file if the name is empty or of a
// class.
std::string BodiesOf(const std::string& source, const std::string& function) {
  if (function.empty()) return source;
  const std::regex begin("\n[^\\s/][^\n]*\\b" + function + "\\(");
  std::string bodies;
  for (std::sregex_iterator at(source.begin(), source.end(), begin), end; at != end; ++at) {
    const auto first = static_cast<std::size_t>(at->position()) + 1;
    bodies += source.substr(first, source.find("\n}", first) - first);
  }
  return bodies.empty() ? source : bodies;
}

TEST(HouseRules, WhereDoINamesCallersThatCall) {
  const std::regex row(R"(\| [^|\n]+\? \| ([^|\n]+) \| ([^|\n]+) \|)"), name(R"(: `(\w+)`|, `(\w+)`)");
  const std::regex caller(R"(`([a-z_0-9]+(?:/[A-Za-z_0-9.]+)+)`(?:: `(\w+)`)?)");
  const std::string page = ReadText(kHouse / "docs/where_do_i.md");
  int callers = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), row), end; at != end; ++at) {
    const std::string here = (*at)[1], called_by = (*at)[2];
    std::string any;
    for (std::sregex_iterator word(here.begin(), here.end(), name); word != end; ++word)
      any.append(any.empty() ? "" : "|").append((*word)[1].matched ? (*word)[1] : (*word)[2]);
    if (any.empty()) continue;
    for (std::sregex_iterator file(called_by.begin(), called_by.end(), caller); file != end;
         ++file, ++callers) {
      const std::string calling = BodiesOf(ReadText(kHouse / (*file)[1].str()), (*file)[2]);
      EXPECT_TRUE(std::regex_search(calling, AnyWordOf(any)))
          << (*file)[1] << " " << (*file)[2] << " calls none of " << any;
    }
  }
  EXPECT_GT(callers, 50) << "or the page is read wrongly";
}

TEST(HouseRules, ArchitectureDocumentListsTheRooms) {
  std::set<std::string> rooms;
  for (const Room& room : ReadLayers(kHouse / "tests/architecture/layers.txt").rooms)
    rooms.insert(room.folder);
  EXPECT_EQ(RoomsInDocument(kHouse / "docs/architecture.md"), rooms);
}

TEST(HouseRules, LocalLinksInDocumentsLeadSomewhere) {
  const std::regex link(R"(\]\(([^)#:\s]+)(#[^)]*)?\))");
  int links = 0;
  for (auto entry = fs::recursive_directory_iterator(kHouse); entry != fs::recursive_directory_iterator();
       ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory() && (name.starts_with('.') || name == "build" || name == "out")) {
      entry.disable_recursion_pending();
    }
    if (entry->path().extension() != ".md") continue;
    const std::string text = ReadText(entry->path());
    for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
      ++links;
      const fs::path target = entry->path().parent_path() / (*found)[1].str();
      EXPECT_TRUE(fs::exists(target))
          << entry->path().lexically_relative(kHouse) << " links to " << (*found)[1];
    }
  }
  EXPECT_GT(links, 10) << "the test looked in the wrong place";
}

}  // namespace
}  // namespace elbowroom::architecture
