// LAYOUT.toml: the parts of an assembly, where they stand, and the gaps that may change.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/layout.h"

namespace elbowroom::cad_import {

struct ImportedLayout {
  core::Layout layout;                // validated; part meshes loaded, in millimetres
  std::vector<std::string> warnings;  // of the part files, each naming its part
};

// Part files are found relative to the layout's own folder; a file that several parts name in the same unit
// is read once and shared. A part's `unit` overrides its file's; the layout's `unit` holds for parts that
// name none and whose files carry none. Throws: Error{kFile} or Error{kFormat} with file, line and key:
// missing, not TOML, a key that is unknown, missing or of the wrong type; what ImportMeshFile and
// Layout::Validate throw, naming file, line and part.
[[nodiscard]] ImportedLayout ImportLayoutFile(const std::filesystem::path& path);

// Writes the layout whole or not at all; the meshes are the caller's to write, to each part's `file`.
// Reading it back gives the same names and numbers, rotations to 1e-12.
// Throws: Error{kFile} if it can't be written, Error{kCad} naming a part without a file.
void WriteLayoutFile(const core::Layout& layout, const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
