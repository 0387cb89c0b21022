#include "tests/architecture/layers_file.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/error.h"

namespace elbowroom::architecture {
namespace {

using Words = std::vector<std::string>;

Words SplitWords(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

bool IsHeader(const std::string& place) { return place.ends_with(".h"); }

class Parser {
 public:
  explicit Parser(std::filesystem::path file) { layers_.file = std::move(file); }

  void ParseLine(std::string line) {
    ++line_;
    line.erase(std::min(line.find('#'), line.size()));
    const Words all = SplitWords(line);
    if (all.empty()) return;
    if (all.size() < 3 || all[2] != ":") Fail("expected 'room|doors|library|use NAME : ...'");
    const Words values(all.begin() + 3, all.end());
    if (all[0] == "room") {
      AddRoom(all[1], values);
    } else if (all[0] == "doors") {
      AddDoors(all[1], values);
    } else if (all[0] == "library") {
      AddLibrary(all[1], values);
    } else if (all[0] == "use") {
      AddUse(all[1], values);
    } else {
      Fail(fmt::format("'{}' is none of room, doors, library, use", all[0]));
    }
  }

  [[nodiscard]] Layers Take() { return std::move(layers_); }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(core::ErrorKind::kFormat, fmt::format("{}:{}: {}", layers_.file.string(), line_, what));
  }

  void AddRoom(const std::string& folder, const Words& places) {
    const auto is_declared = [&](const std::string& name) {
      return std::ranges::any_of(layers_.rooms, [&](const Room& room) { return room.folder == name; });
    };
    if (is_declared(folder)) Fail(fmt::format("room '{}' is declared twice", folder));
    Room room;
    room.folder = folder;
    room.line = line_;
    for (const std::string& place : places) {
      if (place == "*") {
        room.may_include_every_room = true;
      } else if (IsHeader(place) || is_declared(place)) {
        room.places.push_back(place);
      } else {
        Fail(fmt::format("room '{}' is not declared above; a room leans only on rooms above it", place));
      }
    }
    layers_.rooms.push_back(std::move(room));
  }

  void AddDoors(const std::string& folder, const Words& headers) {
    const auto room = std::ranges::find(layers_.rooms, folder, &Room::folder);
    if (room == layers_.rooms.end()) Fail(fmt::format("room '{}' is not declared above", folder));
    for (const std::string& header : headers) {
      if (!IsHeader(header)) Fail(fmt::format("'{}' is no header", header));
      room->doors.push_back(folder + "/" + header);
    }
  }

  void AddLibrary(const std::string& name, const Words& patterns) {
    const bool known =
        std::ranges::any_of(layers_.libraries, [&](const Library& l) { return l.name == name; });
    if (known) Fail(fmt::format("library '{}' is declared twice", name));
    layers_.libraries.push_back({name, patterns});
  }

  void AddUse(const std::string& folder, const Words& values) {
    std::vector<Room*> rooms;
    for (Room& room : layers_.rooms) {
      if (folder == "*" || room.folder == folder) rooms.push_back(&room);
    }
    if (rooms.empty()) Fail(fmt::format("room '{}' is not declared above", folder));
    bool sources_only = false;
    for (const std::string& value : values) {
      if (value == "|") {
        sources_only = true;
        continue;
      }
      const bool known = value == "*" || std::ranges::any_of(layers_.libraries, [&](const Library& l) {
                           return l.name == value;
                         });
      if (!known) Fail(fmt::format("library '{}' is not declared above", value));
      for (Room* room : rooms) {
        if (value == "*") {
          room->may_use_every_library = true;
        } else {
          (sources_only ? room->source_libraries : room->header_libraries).push_back(value);
        }
      }
    }
  }

  Layers layers_;
  int line_ = 0;
};

}  // namespace

const Room* Layers::FindRoomOf(std::string_view path) const {
  const Room* found = nullptr;
  for (const Room& room : rooms) {
    const bool inside = path.starts_with(room.folder) && path.substr(room.folder.size()).starts_with('/');
    if (inside && (found == nullptr || room.folder.size() > found->folder.size())) found = &room;
  }
  return found;
}

const Library* Layers::FindLibraryOf(const std::string& header) const {
  for (const Library& library : libraries) {
    for (const std::string& pattern : library.patterns) {
      if (fnmatch(pattern.c_str(), header.c_str(), 0) == 0) return &library;
    }
  }
  return nullptr;
}

Layers ReadLayers(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw core::Error(core::ErrorKind::kFile, fmt::format("{}: can't be read", file.string()));
  }
  Parser parser(file);
  for (std::string line; std::getline(stream, line);) parser.ParseLine(line);
  return parser.Take();
}

}  // namespace elbowroom::architecture
