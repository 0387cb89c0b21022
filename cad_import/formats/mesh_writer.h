// Models to the formats of other programs, through assimp.
#pragma once

#include <filesystem>
#include <string>

#include "cad_import/model/cad_model.h"

namespace elbowroom::cad_import {

// The bytes of a file of the format that the path's extension names. Throws: as WriteModelFile, but for the
// writing.
[[nodiscard]] std::string EncodeModel(const CadModel& model, const std::filesystem::path& path);

}  // namespace elbowroom::cad_import
