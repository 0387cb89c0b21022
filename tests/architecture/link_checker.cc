#include "tests/architecture/link_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/text_file.h"

namespace elbowroom::architecture {
namespace {

namespace fs = std::filesystem;

// A library of CMake: a room, or several by one name.
struct LinkedLibrary {
  std::vector<std::string> sources;  // from the root
  std::vector<std::string> uses, hides;
};
using Libraries = std::map<std::string, LinkedLibrary>;  // by target

std::vector<std::string> WordsOf(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

// The arguments of elbowroom_room() after its name.
LinkedLibrary RoomOf(const std::string& folder, const std::string& arguments) {
  LinkedLibrary room;
  std::vector<std::string>* list = nullptr;
  for (const std::string& word : WordsOf(arguments)) {
    if (word == "SOURCES") {
      list = &room.sources;
    } else if (word == "USES") {
      list = &room.uses;
    } else if (word == "HIDES") {
      list = &room.hides;
    } else if (list != nullptr) {
      list->push_back(list == &room.sources ? (fs::path(folder) / word).lexically_normal().string() : word);
    }
  }
  return room;
}

void AddLibrariesOf(const fs::path& root, const std::string& folder, Libraries& libraries) {
  static const std::regex kComment("#[^\n]*"), kCall(R"(elbowroom_(rooms?)\(\s*(\w+)([^)]*)\))");
  const std::string text =
      std::regex_replace(test_support::ReadText(root / folder / "CMakeLists.txt"), kComment, "");
  for (std::sregex_iterator call(text.begin(), text.end(), kCall), end; call != end; ++call) {
    const std::string target = "elbowroom_" + (*call)[2].str();
    if ((*call)[1] == "room") {
      libraries[target] = RoomOf(folder, (*call)[3]);
      continue;
    }
    for (const std::string& room : WordsOf((*call)[3])) libraries[target].uses.push_back("elbowroom_" + room);
  }
}

void Follow(const Libraries& libraries, const std::string& target, std::set<std::string>& reached) {
  const auto library = libraries.find(target);
  if (!reached.insert(target).second || library == libraries.end()) return;
  for (const std::string& used : library->second.uses) Follow(libraries, used, reached);
}

std::string SourceOf(const std::string& file) { return file.substr(0, file.rfind('.')) + ".cc"; }

}  // namespace

std::vector<Violation> CheckLinks(const fs::path& root) {
  const std::vector<std::string> files = SourceFilesOf(root);
  std::set<std::string> folders;
  for (const std::string& file : files)
    for (fs::path folder = fs::path(file).parent_path(); !folder.empty(); folder = folder.parent_path())
      folders.insert(folder.string());
  Libraries libraries;
  for (const std::string& folder : folders)
    if (fs::is_regular_file(root / folder / "CMakeLists.txt")) AddLibrariesOf(root, folder, libraries);
  std::map<std::string, std::string> owners;  // of sources
  for (const auto& [target, library] : libraries)
    for (const std::string& source : library.sources) owners[source] = target;

  static const std::regex kInclude(R"re(^\s*#\s*include\s*"([^"]+)".*)re");
  std::vector<Violation> found;
  for (const std::string& file : files) {
    const auto owner = owners.find(SourceOf(file));
    if (owner == owners.end()) continue;
    std::set<std::string> reached;
    Follow(libraries, owner->second, reached);
    for (const std::string& hidden : libraries[owner->second].hides) Follow(libraries, hidden, reached);
    std::istringstream stream(test_support::ReadText(root / file));
    std::smatch match;
    int line_number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++line_number;
      if (!std::regex_match(line, match, kInclude)) continue;
      const auto other = owners.find(SourceOf(match[1]));
      if (other == owners.end() || reached.contains(other->second)) continue;
      found.push_back({file, line_number,
                       fmt::format("{} includes \"{}\" and neither USES nor HIDES {}", owner->second,
                                   match[1].str(), other->second)});
    }
  }
  return found;
}

}  // namespace elbowroom::architecture
