// Finds the includes that break the rules of layers.txt.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/architecture/layers_file.h"

namespace elbowroom::architecture {

struct Violation {
  std::string file;  // from the root; layers.txt itself for a rule about nothing
  int line = 0;
  std::string message;

  [[nodiscard]] bool operator==(const Violation&) const = default;
};

[[nodiscard]] std::string ToString(const Violation& violation);  // "file:line: message"

// Every .h and .cc of the tree, from its root, sorted; hidden folders, build/ and out/ are not part of it.
[[nodiscard]] std::vector<std::string> SourceFilesOf(const std::filesystem::path& root);

// In the order of the files. Every preprocessor branch counts, whether it is compiled or not.
// Throws: core::Error{kFile} when a source can't be read.
[[nodiscard]] std::vector<Violation> CheckTree(const std::filesystem::path& root, const Layers& layers);

// Doors that are no headers.
[[nodiscard]] std::vector<Violation> CheckDoors(const std::filesystem::path& root, const Layers& layers);

}  // namespace elbowroom::architecture
