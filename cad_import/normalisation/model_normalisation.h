// From what a reader gives to a model in millimetres whose bodies can be judged.
#pragma once

#include <filesystem>

#include "cad_import/formats/file_format.h"
#include "cad_import/model/cad_model.h"
#include "cad_import/model/import_options.h"
#include "cad_import/model/raw_scene.h"
#include "core/progress.h"

namespace elbowroom::cad_import {

// In millimetres by the caller's unit, the file's, or the caller's second choice. Instances become rigid:
// scales and mirrors go into shapes. Each shape is welded. Open shapes that stand in one place only are
// joined where they share vertices and together have no open edge: exporters cut one surface up by material
// or group. Then each body is healed. The shape of a file with one instance is listed by its connected
// pieces, unless the reader gave bodies. Throws: Error{kCad} naming the file and its size in each unit when
// nobody gave one, Error{kGeometry} naming the file: no triangle is left, a vertex isn't finite.
[[nodiscard]] CadModel NormaliseModel(RawScene scene, FileFormat format, const ImportOptions& options,
                                      const std::filesystem::path& file, const core::Progress& progress);

}  // namespace elbowroom::cad_import
