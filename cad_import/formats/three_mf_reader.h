// 3MF through lib3mf; assimp 5.2 crashes on valid files of it, and doesn't read its unit.
#pragma once

#include <filesystem>

#include "cad_import/model/raw_scene.h"

namespace elbowroom::cad_import {

// The scene that the file's build items show: a shape for each mesh, an instance for each place. The unit is
// the model's. Throws: Error{kFormat} naming the file when it can't be read, Error{kGeometry} when components
// are nested deeper than can be meant or unroll to more places.
[[nodiscard]] RawScene ReadThreeMf(const std::filesystem::path& file);

}  // namespace elbowroom::cad_import
