// Whether a glTF document stays inside its own buffers and its nodes form trees.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// Throws: Error{kFormat} naming `where`: not JSON, not glTF 1.0 or 2.0, an accessor or view outside its
// buffer, a node that is its own ancestor or nested deeper than 256.
void CheckGltf(std::string_view json_text, const std::string& where);

}  // namespace elbowroom::cad_import
