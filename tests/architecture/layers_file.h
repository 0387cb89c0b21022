// The rules of layers.txt: rooms, what each may include, which of its headers others may, and libraries.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elbowroom::architecture {

struct Room {
  std::string folder;  // from the root, "recon/gl"
  int line = 0;        // of layers.txt
  bool may_include_every_room = false;
  bool may_use_every_library = false;
  std::vector<std::string> places;            // folders and single headers
  std::vector<std::string> doors;             // headers that others may include, "recon/hull/visual_hull.h"
  std::vector<std::string> header_libraries;  // in any file
  std::vector<std::string> source_libraries;  // in .cc files, beside the above
};

struct Library {
  std::string name;
  std::vector<std::string> patterns;
};

struct Layers {
  std::filesystem::path file;
  std::vector<Room> rooms;
  std::vector<Library> libraries;

  // The room with the longest folder that `path` (from the root) lies in.
  [[nodiscard]] const Room* FindRoomOf(std::string_view path) const;
  // The first library with a pattern that `header` matches.
  [[nodiscard]] const Library* FindLibraryOf(const std::string& header) const;
};

// Throws: core::Error{kFile} if it can't be read; {kFormat} naming file and line: a line of no known kind, a
// room or library that isn't declared above, one that is declared twice.
[[nodiscard]] Layers ReadLayers(const std::filesystem::path& file);

}  // namespace elbowroom::architecture
