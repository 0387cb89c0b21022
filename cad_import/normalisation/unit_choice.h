// Which unit a file's numbers are taken in, and whether the outcome is plausible.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "cad_import/formats/file_format.h"
#include "cad_import/model/file_unit.h"
#include "cad_import/model/import_options.h"
#include "cad_import/model/raw_scene.h"

namespace elbowroom::cad_import {

// The caller's unit, with a warning where the file says another; else the file's; else the caller's second
// choice. Throws: Error{kCad} naming `where` when there is none, with the size in each unit and the likely
// unit.
[[nodiscard]] FileUnit ChooseUnit(const RawScene& scene, FileFormat format, const ImportOptions& options,
                                  const std::string& where, std::vector<std::string>& warnings);

// Warns of a size that no payload has, with what it would be in the likely unit.
void WarnOfSize(const Eigen::AlignedBox3d& bounds_mm, const FileUnit& unit,
                std::vector<std::string>& warnings);

}  // namespace elbowroom::cad_import
