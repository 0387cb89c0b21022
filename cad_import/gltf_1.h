// glTF 1.0, as parsers take it.
#pragma once

#include <string>

namespace elbowroom::cad_import {

// The document with a matrix in the place of each node's translation, rotation and scale, which assimp's
// reader of version 1.0 applies in the wrong order (it turns the translation, too). Other versions, and what
// is no document: as they are. The document is one that CheckGltf took. Throws: Error{kFormat} naming
// `where`: one of the three isn't as many numbers as it should be.
[[nodiscard]] std::string WithMatricesIfGltf1(std::string document, const std::string& where);

}  // namespace elbowroom::cad_import
