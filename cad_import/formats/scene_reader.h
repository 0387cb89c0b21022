// Mesh formats through assimp.
#pragma once

#include <filesystem>
#include <string>

#include "cad_import/formats/file_format.h"
#include "cad_import/model/raw_scene.h"

namespace elbowroom::cad_import {

// The scene of a file whose `bytes` were checked; the unit where format and file say one. Vertices pass
// through single precision. Axes are the file's own. Other files are opened only in its folder or below,
// links resolved. Throws: Error{kFormat} naming the file when assimp can't read it or it refers elsewhere,
// Error{kGeometry} when it unrolls to more triangles than can be meant. Thread: one at a time, as assimp has
// one log.
[[nodiscard]] RawScene ReadScene(const std::filesystem::path& file, FileFormat format, std::string bytes);

}  // namespace elbowroom::cad_import
