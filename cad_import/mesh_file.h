// CAD files as one mesh each, and meshes as files.
#pragma once

#include <filesystem>
#include <stop_token>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/import_options.h"
#include "cad_import/model/vertex_field.h"
#include "core/progress.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

struct ImportedMesh {
  core::SharedMesh mesh;  // every instance at its place, in the file's own frame and axes
  std::vector<ImportedPart> parts;
  ImportReport report;
};

// ImportCadFile, flattened. Throws: likewise.
[[nodiscard]] ImportedMesh ImportMeshFile(const std::filesystem::path& file,
                                          const ImportOptions& options = {},
                                          const core::Progress& progress = {},
                                          const std::stop_token& stop = {});

// Writes .ply (binary little-endian, millimetres), .stl (binary, millimetres) or .glb (metres, as its
// specification demands) by the path's extension, whole or not at all; coordinates in single precision.
// Throws: Error{kGeometry} for a mesh that ValidateMesh refuses, Error{kFormat} for another extension,
// Error{kFile} if it can't be written.
void WriteMeshFile(const core::TriangleMesh& mesh, const std::filesystem::path& path);

// Likewise with what the field says of each vertex: .ply as a property of its name beside red, green, blue;
// .glb as an attribute `_NAME` beside COLOR_0. Notes are comments in .ply, `extras` in .glb, and the header
// of .stl, which holds nothing else of the field. Throws: likewise, and Error{kRange} for a .glb of more than
// 4 GiB.
void WriteFieldFile(const core::TriangleMesh& mesh, const VertexField& field,
                    const std::filesystem::path& path);

// Likewise a model: .glb keeps its instances, their names, paths and colours, a shape stored once for each
// colour that it has; .ply and .stl hold it flattened. Axes stay as they are. Throws: likewise.
void WriteModelFile(const CadModel& model, const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
