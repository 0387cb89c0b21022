// Changes of a layout that weren't saved yet, kept beside it in case the program ends.
#pragma once

#include <filesystem>
#include <optional>

#include "cad_import/layout/layout_text.h"

namespace elbowroom::control {

// LAYOUT.toml.unsaved, beside LAYOUT.toml. Those that came while that one was still offered have a number:
// LAYOUT.toml.unsaved2 is the next.
[[nodiscard]] std::filesystem::path AutosaveOf(const std::filesystem::path& layout);

// Whole or not at all. Throws: Error{kFile}.
void WriteAutosave(const cad_import::LayoutText& text);
// The same behind those that are there, which stay. Throws: likewise.
void AppendAutosave(const cad_import::LayoutText& text);

// The text that was kept of this layout, as if it stood in its file; nothing where there is none, it can't be
// read, it isn't TOML, or it is what the file says.
[[nodiscard]] std::optional<cad_import::LayoutText> FindAutosave(const std::filesystem::path& layout);

// The next takes its place. Does nothing where there is none.
void DropAutosave(const std::filesystem::path& layout);

}  // namespace elbowroom::control
