// CAD files to models in millimetres.
#pragma once

#include <filesystem>
#include <stop_token>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/import_options.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

// Reads STEP (AP203, AP214, AP242), IGES, BREP, STL, OBJ, PLY, OFF, glTF, GLB, 3MF, COLLADA, FBX and 3DS:
// from the cache, or in a child of this program, so that no file can crash, hang or fill it
// (docs/cad_import.md). Axes are the file's own: glTF's y stays y. Throws: Error{kFile} (missing,
// unreadable), Error{kFormat} (another format, cut off, damaged), Error{kCad} (no unit known: names the size
// in each; the reader crashed or met its limits), Error{kGeometry} (no triangles, a vertex that isn't
// finite), Error{kCancelled}. PreconditionError unless main called ServeImport. Thread: any.
[[nodiscard]] CadModel ImportCadFile(const std::filesystem::path& file, const ImportOptions& options = {},
                                     const core::Progress& progress = {}, const std::stop_token& stop = {});

}  // namespace elbowroom::cad_import
