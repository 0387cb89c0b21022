// Meshes to the formats of other programs, through assimp.
#pragma once

#include <filesystem>
#include <string>

#include "core/triangle_mesh.h"

namespace elbowroom::cad_import {

// The bytes of a file of the format that the path's extension names. Throws: as WriteMeshFile, but for the
// writing.
[[nodiscard]] std::string EncodeMesh(const core::TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
