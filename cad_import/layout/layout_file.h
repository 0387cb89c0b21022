// LAYOUT.toml: the parts of an assembly, where they stand, and the gaps that may change.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "cad_import/layout/layout_sections.h"
#include "cad_import/layout/layout_text.h"
#include "cad_import/layout/part_shelf.h"
#include "core/layout.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

struct ImportedLayout {
  core::Layout layout;                // validated; part meshes loaded, in millimetres
  std::vector<std::string> warnings;  // of the part files, each naming its part
  std::vector<LayoutSection> sections;
};

// Part files are found relative to the layout's own folder; parts that name one file, in the same unit and of
// the same node, share its mesh. A part's `unit` overrides its file's; the layout's `unit` holds for parts
// that name none and whose files carry none. Throws: Error{kFile} or Error{kFormat} with file, line and key:
// missing, not TOML, a key that is unknown, missing or of the wrong type; what ImportMeshFile and
// core::FindLayoutFault report, with file, line and name of the entry; Error{kCancelled}.
[[nodiscard]] ImportedLayout ImportLayoutFile(const std::filesystem::path& path,
                                              const core::Progress& progress = {},
                                              const std::stop_token& stop = {});

// The same for a text, as if it stood in its file. Throws: the same.
[[nodiscard]] ImportedLayout ImportLayoutText(const LayoutText& text, const core::Progress& progress = {},
                                              const std::stop_token& stop = {});
// Likewise with the part files that are on the shelf already; those that aren't stay there.
[[nodiscard]] ImportedLayout ImportLayoutText(const LayoutText& text, PartShelf& shelf,
                                              const core::Progress& progress = {},
                                              const std::stop_token& stop = {});

// Writes the layout whole or not at all; the caller writes the meshes, to each part's `file`. Reading it back
// gives the same names and numbers, rotations to 1e-12. A file that is there already is changed in place
// (ChangeInto). Throws: Error{kFile} if it can't be written, Error{kCad} naming a part without a file; for a
// file that is there, as ImportLayoutFile: a file that can't be read isn't overwritten.
void WriteLayoutFile(const core::Layout& layout, const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
