// A CAD file, read in this process. For a child that may crash: see import_process.h.
#pragma once

#include <filesystem>
#include <vector>

#include "cad_import/model/import_options.h"
#include "cad_import/packed_model.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

// Loads the libraries that a file of this name needs. To be called before the limits are set, because they
// are meant for the file alone. Throws: Error{kFile}.
void PrepareToRead(const std::filesystem::path& file);

// Throws: Error{kFile} (missing, unreadable, over 1 GiB), Error{kFormat} (another format, cut off, damaged,
// refers outside its folder), what NormaliseModel throws. A damaged file may also make a parser crash, hang
// or use up the memory.
[[nodiscard]] PackedModel ReadCadFile(const std::filesystem::path& file, const ImportOptions& options,
                                      const core::Progress& progress = {});

}  // namespace elbowroom::cad_import
