// Meshes with a number at each vertex, as files of other programs.
#pragma once

#include <filesystem>
#include <string>

#include "cad_import/model/vertex_field.h"
#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// The bytes of a .ply or .glb file of the mesh, its field and the notes. Throws: as WriteFieldFile, but for
// the writing.
[[nodiscard]] std::string EncodeField(const core::TriangleMesh& mesh, const VertexField& field,
                                      const std::filesystem::path& path);

// The 80 bytes that a binary STL file begins with, holding the notes as far as they fit.
[[nodiscard]] std::string StlHeader(const VertexField& field);

}  // namespace elbowroom::cad_import
