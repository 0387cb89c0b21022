// The section planes of a LAYOUT.toml, saved while its trial runs.
#pragma once

#include <filesystem>
#include <vector>

#include "cad_import/layout/layout_sections.h"

namespace elbowroom::control {

// Changes the file's sections, and nothing else in it: comments and all other entries stay as they are.
// Written whole or not at all. Throws: Error{kFile} when it can't be read or written, or when another program
// is changing the folder's layouts just now; as cad_import::ChangeSections.
void SaveSections(const std::filesystem::path& layout,
                  const std::vector<cad_import::LayoutSection>& sections);

}  // namespace elbowroom::control
