// Whether a PLY file holds the elements that its header claims.
#pragma once

#include <string>
#include <string_view>

namespace elbowroom::cad_import {

// Walks every element without keeping any. `where` names the file.
// Throws: Error{kFormat}: no valid header, an element or a list that runs past the end of the file.
void CheckPly(std::string_view bytes, const std::string& where);

}  // namespace elbowroom::cad_import
