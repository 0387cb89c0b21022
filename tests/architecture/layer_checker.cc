#include "tests/architecture/layer_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <regex>

#include "core/error.h"

namespace elbowroom::architecture {
namespace {

namespace fs = std::filesystem;

bool Contains(const std::vector<std::string>& values, const std::string& value) {
  return std::ranges::find(values, value) != values.end();
}

bool IsLeftOut(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name.starts_with('.') || name == "build" || name == "out";
}

// The standard library's headers are the only ones without a slash or a dot (<vector>).
bool IsStandard(const std::string& header) { return header.find_first_of("/.") == std::string::npos; }

std::optional<std::string> WhyRoomIsWrong(const Room& from, const Room& to, const std::string& header) {
  if (from.folder == to.folder || from.may_include_every_room) return std::nullopt;
  if (!Contains(from.places, to.folder) && !Contains(from.places, header))
    return fmt::format("{} must not include {} (\"{}\")", from.folder, to.folder, header);
  if (Contains(to.doors, header)) return std::nullopt;
  return fmt::format("\"{}\" is inner to {}: include one of its doors (layers.txt)", header, to.folder);
}

std::optional<std::string> WhyLibraryIsWrong(const Room& from, const Library& library,
                                             const std::string& header, bool in_header) {
  if (from.may_use_every_library || Contains(from.header_libraries, library.name)) return std::nullopt;
  if (Contains(from.source_libraries, library.name)) {
    if (!in_header) return std::nullopt;
    return fmt::format("{} belongs in .cc files of {}, not in a header (<{}>)", library.name, from.folder,
                       header);
  }
  return fmt::format("{} must not include {} (<{}>)", from.folder, library.name, header);
}

std::optional<std::string> WhyIncludeIsWrong(const Layers& layers, const Room& from,
                                             const std::string& header, bool in_header) {
  if (const Room* to = layers.FindRoomOf(header)) return WhyRoomIsWrong(from, *to, header);
  if (const Library* library = layers.FindLibraryOf(header)) {
    return WhyLibraryIsWrong(from, *library, header, in_header);
  }
  if (IsStandard(header) || from.may_use_every_library) return std::nullopt;
  return fmt::format("<{}> belongs to no library of layers.txt; own headers are included from the root",
                     header);
}

void CheckFile(const fs::path& root, const std::string& file, const Layers& layers,
               std::vector<Violation>& found) {
  const Room* room = layers.FindRoomOf(file);
  if (room == nullptr) {
    found.push_back({file, 1, "lies in no room of layers.txt"});
    return;
  }
  std::ifstream stream(root / file);
  if (!stream) throw core::Error(core::ErrorKind::kFile, fmt::format("{}: can't be read", file));
  static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
  const bool in_header = file.ends_with(".h");
  std::smatch match;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;
    if (!std::regex_match(line, match, kInclude)) continue;
    if (auto why = WhyIncludeIsWrong(layers, *room, match[2], in_header)) {
      found.push_back({file, line_number, std::move(*why)});
    }
  }
}

}  // namespace

std::string ToString(const Violation& violation) {
  return fmt::format("{}:{}: {}", violation.file, violation.line, violation.message);
}

std::vector<std::string> SourceFilesOf(const fs::path& root) {
  std::vector<std::string> files;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator();
       ++entry) {
    if (entry->is_directory() && IsLeftOut(entry->path())) {
      entry.disable_recursion_pending();
      continue;
    }
    const std::string extension = entry->path().extension().string();
    if (entry->is_regular_file() && (extension == ".h" || extension == ".cc")) {
      files.push_back(entry->path().lexically_relative(root).generic_string());
    }
  }
  std::ranges::sort(files);
  return files;
}

std::vector<Violation> CheckDoors(const fs::path& root, const Layers& layers) {
  std::vector<Violation> found;
  for (const Room& room : layers.rooms) {
    for (const std::string& door : room.doors) {
      if (fs::is_regular_file(root / door)) continue;
      found.push_back({layers.file.lexically_relative(root).generic_string(), room.line,
                       fmt::format("door '{}' is no header of the tree", door)});
    }
  }
  return found;
}

std::vector<Violation> CheckTree(const fs::path& root, const Layers& layers) {
  std::vector<Violation> found;
  for (const Room& room : layers.rooms) {
    if (!fs::is_directory(root / room.folder)) {
      found.push_back({layers.file.lexically_relative(root).generic_string(), room.line,
                       fmt::format("room '{}' is no folder of the tree", room.folder)});
    }
  }
  for (const std::string& file : SourceFilesOf(root)) CheckFile(root, file, layers, found);
  return found;
}

}  // namespace elbowroom::architecture
