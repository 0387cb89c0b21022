// A layout as `elbowroom layout` prints it.
#pragma once

#include "app/cli/options/command.h"
#include "cad_import/layout/layout_file.h"

namespace elbowroom::cli {

// Its parts with size and place, groups, gaps, pairs and warnings, at the initial values of the gaps.
[[nodiscard]] CommandResult ListingOf(const cad_import::ImportedLayout& imported,
                                      const std::filesystem::path& file);

}  // namespace elbowroom::cli
