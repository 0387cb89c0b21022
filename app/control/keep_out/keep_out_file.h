// A keep-out volume as a mesh file of other programs.
#pragma once

#include <filesystem>

#include "app/control/keep_out/keep_out_job.h"

namespace elbowroom::control {

// Writes .stl, .ply or .glb by the path's extension, whole or not at all, with the error's bound and from
// what the volume comes. In .ply and .glb each vertex has its dwell in seconds, and the report's colour for
// it: from pale (0) to dark red (the longest). Throws: core::Error{kFormat, kFile, kRange} as
// cad_import::WriteFieldFile.
void WriteKeepOut(const KeepOutRequest& request, const KeepOut& keep_out, const std::filesystem::path& file);

}  // namespace elbowroom::control
