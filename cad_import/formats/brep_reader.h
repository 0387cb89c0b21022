// STEP, IGES and BREP through OpenCASCADE.
#pragma once

#include <filesystem>

#include "cad_import/formats/file_format.h"
#include "cad_import/model/import_options.h"
#include "cad_import/model/raw_scene.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

// The scene of a STEP (AP203, AP214, AP242), IGES or BREP file: a shape for each different body, an instance
// for each place in the assembly; names, colours; tessellated to `options.tolerance_mm`. STEP's lengths are
// already in millimetres by what the file declares (`are_mm`). Throws: Error{kFormat} naming the file when it
// can't be read or refers to a file outside its folder, Error{kGeometry} when no body could be meshed.
// Thread: one at a time, as OpenCASCADE's readers share settings.
[[nodiscard]] RawScene ReadBrep(const std::filesystem::path& file, FileFormat format,
                                const ImportOptions& options, const core::Progress& progress);

}  // namespace elbowroom::cad_import
